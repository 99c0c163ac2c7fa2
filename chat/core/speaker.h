#pragma once

#include <deque>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "chat/core/hub_line.h"
#include "chat/text/sentence_cutter.h"

namespace chat {

/// Speaks the sentences of a reply one after the other by the hub's macro Speak, which keeps voice
/// and lips in step. While one sounds, the voice prepares the next (Text.next). What a tag asks for
/// is said before its sentence, or where the voice passes its place (BOOKMARK). Knows what was
/// really heard, also of a sentence that was stopped.
/// Lifetime: clock and hub outlive it. Thread: the scheduler's.
class Speaker {
 public:
  struct Names {
    std::string voice = "SSM";
    std::string macros = "AM-MCL";
  };
  struct Hooks {
    std::function<void(const std::string& text)> begins;  ///< a sentence goes to the voice
    std::function<void()> sounds;                         ///< its first sound
    std::function<void(const vm::Error& error)> failed;   ///< it could not be spoken
    std::function<void()> done;                           ///< everything has been said
    std::function<void()> stopped;  ///< somebody else has stopped the voice, or spoken with it
  };
  Speaker(vm::Scheduler& clock, HubLine& hub, Names names, Hooks hooks);
  ~Speaker();
  Speaker(const Speaker&) = delete;

  /// A reply begins. REQUIRES: nothing is being said.
  void Begin();
  /// `counts`: it is a part of what was said to the user (an apology is not).
  void Add(Sentence sentence, bool counts = true);
  /// The reply has no further sentences: `done` comes, perhaps at once.
  void NoMore();
  /// Silence, as soon as it can be had. `then` is called when the voice has stopped and it is known
  /// what was heard; after kPatience in any case.
  void Stop(std::function<void()> then);
  void OnVoice(const vm::Message& message);
  /// What was heard of the reply.
  const std::string& heard() const { return heard_; }
  /// Without a voice sentences count as read.
  void set_voiceless(bool voiceless) { voiceless_ = voiceless; }

  static constexpr vm::Time kPatience = std::chrono::milliseconds(3000);

 private:
  struct Piece {
    Sentence sentence;
    bool counts = true;
    std::string spoken;  ///< with a bookmark for each cue within
    std::string mark;    ///< the beginning of the names of its bookmarks
  };
  void Next();
  void PrepareNext();
  void OnSpoken(const vm::Result<std::string>& answer);
  void AskWhatWasHeard();
  void TakeHeard(const std::string& text);
  void EndPiece();
  void FinishStop();
  void Perform(const Cue& cue);

  vm::Scheduler& clock_;
  HubLine& hub_;
  const Names names_;
  const Hooks hooks_;
  std::deque<Piece> queue_;
  std::optional<Piece> current_;
  bool no_more_ = true;
  bool sounded_ = false;   // the present sentence has
  bool prepared_ = false;  // the next one is being prepared by the voice
  bool voiceless_ = false;
  std::string heard_;
  std::function<void()> stopping_;
  vm::TimerId stop_timer_ = 0;
  unsigned last_mark_ = 0;
  unsigned piece_ = 0;                   // answers to earlier ones do not count
  double spoken_ms_ = 0, whole_ms_ = 0;  // of the last utterance, as the voice tells
};

/// The beginning of `text` up to the last of the words that were heard; those alone if they do not
/// stand in it. Pure.
std::string HeardPart(std::string_view text, std::string_view words);

}  // namespace chat
