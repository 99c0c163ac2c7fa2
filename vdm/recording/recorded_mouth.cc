#include "vdm/recording/recorded_mouth.h"

#include <algorithm>
#include <cmath>

namespace vdm {

void RecordedMouth::Blend(std::uint64_t sample, MouthFrame& frame) const {
  const std::uint64_t at = sample / kHopSamples;
  if (at >= instants.size()) return;
  const auto& [known, trust] = instants[at];
  const float silence = frame.sounds.empty() ? 0 : frame.sounds.front();
  const auto towards = [share = trust * (1 - silence)](float& now, float then) {
    now = std::lerp(now, then, share);
  };
  for (std::size_t i = 0; i < kMouthParameters; ++i) towards(frame.mouth[i], known.mouth[i]);
  towards(frame.seal, known.seal);
  towards(frame.tongue, known.tongue);
}

}  // namespace vdm
