#pragma once

#include <memory>
#include <string>

#include "ssm/voice/samples.h"
#include "ssm/voice/speech_engine.h"

namespace ssm {

/// A text that is ready to be spoken. Constant once it is ready, but for the samples coming in.
struct Utterance {
  std::string text{};         ///< as given, with tags
  std::string spoken_text{};  ///< without tags
  SpeechPlan plan{};
  std::shared_ptr<SampleBuffer> samples{};  ///< size = the plan's duration

  Millis duration() const { return vm::TotalDuration(plan.phonemes); }
  /// The words begun by `spoken`, separated by blanks.
  std::string SpokenWords(Millis spoken) const;
};

enum class SoundFormat { kWav, kRaw };

/// Writes the samples to `path` and the text and phonemes to `path`.info, as the original did:
///     input_text: <EMPH>Hello.</EMPH>
///     spoken_text: Hello.
///     -----
///     pau [210]                       one phoneme a line
///     -----
/// Errors: kUnavailable. REQUIRES: the samples are complete.
vm::Result<void> SaveUtterance(const Utterance& utterance, const std::string& path,
                               SoundFormat format);
/// The phonemes as a label file of HTK: START END NAME, in units of 100 ns, one a line.
vm::Result<void> SaveLabels(const Utterance& utterance, const std::string& path);
/// What stands in `path`.info. Errors: kUnavailable, kSyntax or kBadValue with the file's name.
struct InfoFile {
  std::string text{};
  std::string spoken_text{};
  vm::PhonemeList phonemes{};  ///< empty if there are none
};
vm::Result<InfoFile> ReadInfo(const std::string& path);
/// The reverse of SaveUtterance. The phonemes are needed; sound and phonemes may differ in length
/// by 50 ms (the sound is cut or filled with silence), else kBadValue.
vm::Result<std::shared_ptr<Utterance>> LoadUtterance(const std::string& path, SoundFormat format);

}  // namespace ssm
