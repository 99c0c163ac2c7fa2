#pragma once

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

/// A piece of text spoken in one manner.
struct SpeechSpan {
  std::string text{};
  Millis pause_before{0};
  std::string mark{};   ///< name of a mark at its beginning (after the pause); empty = none
  std::string voice{};  ///< one of the engine's own names
  double stretch = 1;   ///< relative duration: 2 = twice as slow
  double pitch = 1;     ///< relative pitch
  double volume = 1;    ///< relative loudness of the samples
  std::string audio{};  ///< a sound file played instead of `text` where an engine can; else empty
  Feeling feeling{};
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
  std::string unspoken{};  ///< a sentence for people if characters had to be left out; else empty
  std::shared_ptr<const Detail> detail{};
};

inline constexpr Millis kEmptyPause{10};

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
