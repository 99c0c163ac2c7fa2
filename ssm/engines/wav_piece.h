#pragma once

#include <string>
#include <vector>

#include "ssm/engines/piece_engine.h"

namespace ssm {

/// Any sound file libsndfile reads, as 16 kHz mono (channels are averaged). At most an hour.
/// Errors: kUnavailable (cannot be read), kBadValue (no sound in it, a rate out of range),
/// kTooLong.
vm::Result<std::vector<std::int16_t>> ReadSoundFile(const std::string& path);

/// A folder of our own for files between programs; gone with this object. Throws
/// std::runtime_error if it cannot be made.
class TemporaryFolder {
 public:
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  std::string File(const std::string& name) const { return path_ + "/" + name; }

 private:
  std::string path_;
};

/// Louder by a factor; what would be beyond 16 bit is bent (Limited).
void ScaleSamples(std::vector<std::int16_t>& samples, double volume);

/// Makes phonemes and sound agree: the phonemes are lengthened by a pause, or their last ones cut,
/// until they last as long as the sound.
void FitToSound(vm::PhonemeList& phonemes, const std::vector<std::int16_t>& samples);

/// The words of `text`, between blanks, spread over the time that is not pause, by length. For
/// engines that do not tell their words.
std::vector<WordTime> GuessWords(const std::string& text, const vm::PhonemeList& phonemes);

}  // namespace ssm
