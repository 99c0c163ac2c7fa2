#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "task_manager/platform/json_line.h"
#include "vm_protocol/core/result.h"

namespace vxml {

using Millis = std::chrono::milliseconds;

/// So long after the prompts comes input that has no time of its own.
inline constexpr Millis kReaction{500};

/// A piece of a prompt, in the order it is rendered.
struct Segment {
  enum class Kind { kText, kAudio, kMark, kPause, kCommand };
  Kind kind = Kind::kText;
  std::string text;      ///< words; audio URI; mark name; protocol line (kCommand)
  Millis pause{0};       ///< kPause; of kCommand: wait so long before it
  std::string language;  ///< kText
  /// kCommand: runs beside the words instead of between them (<media type="face">).
  bool parallel = false;
  std::string emotion;  ///< kText: the voice follows this feeling; "" = it does not
  /// kAudio: the sound itself where it lies on no disk here (http, data); null otherwise.
  std::shared_ptr<const std::string> sound = nullptr;
  /// kCommand: the author's own (<native>), which is sent even if its words are cut off.
  bool native = false;
};

/// One <prompt> ready to be rendered. Its expressions have been evaluated.
struct Prompt {
  std::vector<Segment> segments;
  std::string text;  ///< the words alone
  std::string ssml;  ///< an SSML 1.0 <speak> document
  std::string language;
  bool bargein = true;
  bool hotword = false;
  std::optional<Millis> timeout;
  /// What the face shows meanwhile (HAPPY, ...), each once, in order; without NEUTRAL.
  std::vector<std::string> Feelings() const;
  /// True of a <native> that stands by itself: no prompt of the author's.
  bool IsNative() const;
};

struct Hypothesis {
  std::string text;
  double confidence = 1.0;
};

/// What came from the user.
struct Input {
  enum class Kind { kSpeech, kDtmf, kSilence, kTooLong, kHangup };
  Kind kind = Kind::kSilence;
  std::vector<Hypothesis> hypotheses;  ///< best first; keys as one text
  std::string mark;                    ///< last mark played before the input, "" for none
  Millis mark_time{0};                 ///< since that mark
  std::string termchar;                ///< the key that ended dtmf input, "" if none did
  Millis recorded{0};                  ///< length of the utterance's recording, 0 if there is none
  std::size_t recorded_bytes = 0;      ///< of it; 0: as many as it would have
  std::string recording;               ///< its URI as RecordResult::uri
  bool recording_cut = false;          ///< it was ended because it was too long
};

struct KeysState {
  bool complete = false;      ///< the keys so far match a grammar
  bool can_continue = false;  ///< more keys may match
};

/// What a waiting state listens for.
struct Listen {
  bool voice = true;
  bool dtmf = true;
  bool hotword = false;  ///< after the prompts too, what matches nothing is not heard
  Millis timeout{5000};
  Millis interdigit_timeout{3000};
  Millis term_timeout{0};
  Millis max_speech{60000};
  std::string termchar = "#";
  std::string language;
  std::string item;  ///< name of the form item, for people
  std::function<KeysState(const std::string& keys)> keys;
  std::function<bool(const std::string& words)> accepts;
  /// The active voice grammars as phrases for the ear (slot Grammar.load); "" = they cannot be
  /// written so, and the ear takes everything.
  std::function<std::string(std::size_t most_bytes)> phrases;
  bool attention = true;    ///< the agent looks at the user and nods (property attention)
  bool keep_sound = false;  ///< what is said is recorded (property recordutterance)
};

struct RecordRequest {
  Listen listen;
  bool beep = false;
  bool dtmf_term = true;
  Millis max_time{60000};
  Millis final_silence{3000};
  std::string type;
};
struct RecordResult {
  enum class Kind { kRecorded, kSilence, kHangup, kInput, kUnsupported, kBadFormat };
  Kind kind = Kind::kRecorded;
  Millis duration{0};
  std::size_t bytes = 0;
  std::string termchar;
  bool reached_max = false;
  std::string uri;  ///< recording:NAME for Recording(), "" if it exists only as a number
  Input input;      ///< kInput: what matched a grammar and ended the recording
};

struct TransferRequest {
  std::string destination;
  std::string type;  ///< bridge, blind, consultation
  Millis connect_timeout{0};
  Millis max_time{0};
  Listen listen;
};
struct TransferResult {
  std::string outcome;  ///< the item's value, or an event (connection.* or error.*)
  Millis duration{0};
  Input input;  ///< what matched a grammar and ended a bridged call
  bool ended_by_input = false;
};

/// A conversation that is no dialogue of the document's (<object classid="builtin:chat">).
struct TalkRequest {
  std::string goal;         ///< what it is for, in words
  std::string end_phrases;  ///< by which the user ends it, with | between
  int turns = 10;           ///< of the user's, at most
  Millis silence{10'000};   ///< nobody speaks so long: it is over
  Millis max_time{600'000};
};
struct TalkResult {
  enum class Kind { kOver, kHangup, kUnsupported, kBusy, kFailed };
  Kind kind = Kind::kOver;
  std::string reason{};  ///< kOver: turns, silence, ended, stopped, maxtime; else what is wrong
  int turns = 0;
  std::string last{};    ///< what the user said last
  std::string result{};  ///< a word of the model's
  struct Words {
    bool user = false;
    std::string text;
  };
  std::vector<Words> words{};  ///< what both said, in turns
};

/// Where a dialogue meets people. Calls block; time is the platform's own (virtual in tests).
/// Thread: the session's.
class Platform {
 public:
  virtual ~Platform() = default;
  /// Plays the prompts and waits for one input.
  virtual Input Collect(const std::vector<Prompt>& prompts, const Listen& listen) = 0;
  /// Plays to the end. False: the user hung up meanwhile.
  virtual bool Play(const std::vector<Prompt>& prompts) = 0;
  virtual RecordResult Record(const std::vector<Prompt>& prompts, const RecordRequest& request) = 0;
  virtual TransferResult Transfer(const std::vector<Prompt>& prompts,
                                  const TransferRequest& request) = 0;
  /// Plays the prompts and lends the user to whoever converses, until that is over.
  virtual TalkResult Talk(const std::vector<Prompt>& prompts, const TalkRequest& request) {
    Play(prompts);
    static_cast<void>(request);
    return {.kind = TalkResult::Kind::kUnsupported, .reason = "it needs a hub with voice and ear"};
  }
  virtual void Disconnect() = 0;
  /// The bytes of a recording by its URI. Errors: kUnavailable (there is none such, any more).
  virtual vm::Result<std::string> Recording(const std::string& uri) const {
    return vm::Fail(vm::Errc::kUnavailable, "no recording '" + uri + "'");
  }
  /// A raw command of the protocol (<native>).
  virtual void Native(const std::string& line) = 0;
  /// A fetch that may take long begins and ends (fetchaudio, a thinking look).
  virtual void Fetching(const std::string& uri, bool begins) = 0;
  virtual Millis Now() const = 0;
  /// A line of the transcript; `t` and `type` are put in front by the platform.
  virtual void Report(std::string_view type, const JsonLine& fields) = 0;
};

}  // namespace vxml
