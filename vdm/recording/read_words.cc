#include <iostream>

#include "vdm/features/sound_features.h"
#include "vdm/recording/recording_reader.h"

namespace vdm {

RecordedMouth ReadWords(const std::vector<std::int16_t>& samples, std::string_view program) {
  constexpr std::size_t kLongS = 30, kMostS = 1200;  // memory goes with the length
  const std::size_t seconds = samples.size() / kSampleRateHz;
  if (seconds > kMostS) {
    std::cerr << program << ": no words are recognised in a sound of more than " << kMostS << " s"
              << std::endl;
    return {};
  }
  const auto reader = RecordingReader::Open();
  if (!reader) return {};
  if (seconds > kLongS) {
    std::cerr << program << ": recognising the words of " << seconds << " s of sound" << std::endl;
  }
  return (*reader)->Read(samples);
}

}  // namespace vdm
