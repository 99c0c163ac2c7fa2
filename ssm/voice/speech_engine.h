#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "ssm/voice/emotion.h"
#include "ssm/voice/samples.h"
#include "vm_protocol/core/phonemes.h"
#include "vm_protocol/core/result.h"

namespace ssm {

using Millis = std::chrono::milliseconds;

/// Intonation beyond a factor for the pitch. Laid over the sound (LayeredEngine): engines need not
/// know it.
struct Intonation {
  struct Target {
    double at01 = 0;  ///< of the element's time, from 0 to 1
    double factor = 1;
    double shift_hz = 0;
    double hz = 0;  ///< not 0: that very pitch
    bool operator==(const Target&) const = default;
  };
  double hz = 0;                  ///< not 0: the mean pitch
  double shift_hz = 0;            ///< added to the mean pitch
  double range = 1;               ///< factor of how far the pitch goes from its mean, in log Hz
  std::vector<Target> contour{};  ///< by at01; between them straight, before and behind as at them
  bool operator==(const Intonation&) const = default;
};

/// A piece of text spoken in one manner.
struct SpeechSpan {
  std::string text{};
  Millis pause_before{0};
  std::string mark{};  ///< name of a mark at its beginning (after the pause); empty = none
  bool begins_sentence = false;  ///< the text is not analysed together with what is before it
  std::string voice{};           ///< one of the engine's own names
  double stretch = 1;            ///< relative duration: 2 = twice as slow
  double pitch = 1;              ///< relative pitch
  double volume = 1;             ///< relative loudness of the samples
  std::string audio{};  ///< a sound file played instead of `text` where an engine can; else empty
  Feeling feeling{};
  /// How the sound file is played.
  struct Clip {
    Millis begin{0}, end{0};  ///< of the file; end 0 = to its end
    double repeats = 1;       ///< so many times
    Millis most{0};           ///< no longer than that altogether; 0 = no limit
    double speed = 1;
  };
  Clip clip{};
  std::string gender{};    ///< "male" or "female": a speaker of that kind, where `voice` names none
  std::string language{};  ///< the markup's word for it ("en", "ja-JP"); empty = by its script
  Intonation intonation{};
  unsigned depth = 0;    ///< how many elements of the markup set this manner, one in the other
  Millis lasts{0};       ///< all spans of the same `element` together; 0 = as long as they take
  unsigned element = 0;  ///< which element `lasts` and a contour belong to
};

struct WordTime {
  std::string text{};
  Millis start{0};
  Millis end{0};
  bool operator==(const WordTime&) const = default;
};
struct MarkTime {
  std::string name{};
  Millis at{0};
  bool operator==(const MarkTime&) const = default;
};

/// Everything that is known of an utterance before there is sound.
struct SpeechPlan {
  /// The engine's own notes on how to make the sound.
  struct Detail {
    virtual ~Detail() = default;
  };
  vm::PhonemeList
      phonemes{};  ///< never empty: a text with nothing to say is one pause, kEmptyPause
  std::vector<WordTime> words{};
  std::vector<MarkTime> marks{};
  /// A sentence for people if something had to be left out or could not be done; else empty.
  std::string unspoken{};
  std::shared_ptr<const Detail> detail{};
};

inline constexpr Millis kEmptyPause{10};
/// How long a sound file is played at most, with all its repeats.
inline constexpr Millis kLongestPlayed{600'000};

/// One voice an engine has.
struct VoiceInfo {
  std::string name{};
  std::string language{};  ///< "en", "ja", ...
  bool female = false;
  bool pitch_adjustable = true;
  bool listed = true;  ///< part of SpeakerSet; the others are known by name all the same
};

/// Turns text into phonemes with times, and those into sound. Two steps, since a face needs the
/// phonemes before there is any sound, and gets them several times sooner so.
/// Thread: calls may come from different threads; an engine that cannot stand it locks.
/// Errors: kUnavailable (the engine failed), kStopped (cancelled), kLimit.
class SpeechEngine {
 public:
  virtual ~SpeechEngine() = default;
  /// Constant; not empty; the first is the default.
  virtual const std::vector<VoiceInfo>& voices() const = 0;
  /// Whether text in a language (primary tag, lower case) can be spoken.
  virtual bool Speaks(const std::string& language) const {
    return std::ranges::find(voices(), language, &VoiceInfo::language) != voices().end();
  }
  /// Whole milliseconds; deterministic: the same spans give the same plan.
  virtual vm::Result<SpeechPlan> Plan(const std::vector<SpeechSpan>& spans,
                                      const std::atomic<bool>& cancelled) = 0;
  /// Fills `samples`, whose size is exactly the plan's duration, from front to end; leaves it
  /// complete unless an error is returned.
  virtual vm::Result<void> Render(const SpeechPlan& plan, SampleBuffer& samples) = 0;
  /// True if Plan takes some tens of ms at most for a short text, whatever happens; else it is not
  /// called on the loop's thread while time is real.
  virtual bool Prompt(const std::vector<SpeechSpan>&) const { return true; }
  /// Which voice takes runs in another language. Errors: kBadValue (no such voice), kUnavailable.
  virtual vm::Result<void> ChooseVoice(const std::string& language, const std::string& voice) {
    return vm::Fail(vm::Errc::kUnavailable,
                    "this engine has no voices to choose from (" + language + ", " + voice + ")");
  }
};

}  // namespace ssm
