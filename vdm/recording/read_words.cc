#include <iostream>

#include "vdm/features/sound_features.h"
#include "vdm/recording/recording_reader.h"

namespace vdm {

RecordedMouth ReadWords(const std::vector<std::int16_t>& samples) {
  constexpr std::size_t kLongS = 30;
  const auto reader = RecordingReader::Open();
  if (!reader) return {};
  if (const std::size_t seconds = samples.size() / kSampleRateHz; seconds > kLongS) {
    std::cerr << "vdm: recognising the words of " << seconds << " s of sound" << std::endl;
  }
  return (*reader)->Read(samples);
}

}  // namespace vdm
