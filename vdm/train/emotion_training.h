#pragma once

#include <functional>
#include <string>
#include <vector>

#include "vdm/prosody/discriminant.h"
#include "vdm/train/dice.h"
#include "vm_protocol/core/result.h"

namespace vdm {

/// One recording somebody has said the emotion of.
struct EmotionTake {
  std::string speaker;
  std::string label;
  std::vector<std::int16_t> samples;  ///< 16 kHz mono
};

/// The class beside which the others are: what a speaker does in it is the speaker's usual.
inline constexpr const char* kNeutral = "neutral";

/// Synthetic voices (tables/voices.txt) that speak in the manners of tables/feelings.txt, and by
/// some per cent otherwise by chance, as people are never twice alike. `espeak_helper`: the path of
/// ssm_espeak. `said` is told of each voice. Error: that of the engine that fails.
vm::Result<std::vector<EmotionTake>> MakeEmotionTakes(
    const std::string& espeak_helper, const std::vector<std::string>& without, Dice dice,
    const std::function<void(const std::string&)>& said);

/// Recordings of people: a list, each line `WAV LABEL [SPEAKER]`, paths without blanks, beside the
/// list where they are relative; `#` begins a comment. Without SPEAKER all are of one. Errors:
/// kUnavailable, kBadValue with file and line.
vm::Result<std::vector<EmotionTake>> ReadEmotionTakes(const std::string& list);

/// The phrases of the takes as a running vdm measures them, once it knows the speaker's usual from
/// all that the speaker said with the label neutral. Error: kBadValue for a speaker without that.
vm::Result<std::vector<Example>> MeasureTakes(const std::vector<EmotionTake>& takes);

/// The file of the functions learned from the takes; their classes are neutral and the others in
/// the order of the alphabet. `said` is told how many phrases are told apart rightly when each
/// speaker is left out of the learning in turn. Errors: those of MeasureTakes and
/// LearnDiscriminant.
vm::Result<std::string> TeachEmotion(const std::vector<EmotionTake>& takes, const std::string& from,
                                     const std::function<void(const std::string&)>& said);

}  // namespace vdm
