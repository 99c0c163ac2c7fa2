#include "vdm/prosody/head_inputs.h"

#include <algorithm>
#include <cmath>

namespace vdm {
namespace {
constexpr float kMost = 3;         // deviations
constexpr float kForgets = 0.85F;  // of the pitch, in 10 ms without a voice
}  // namespace

void HeadInputs::Add(const ProsodyFrame& frame, const SpeakerUsual& usual,
                     const PhraseTracker& phrases, const std::vector<float>& sounds) {
  const auto within = [](double value) {
    return std::clamp(static_cast<float>(value), -kMost, kMost);
  };
  const float pitch_before = ring_[last_][kPitch];
  last_ = (last_ + 1) % kKept;
  std::vector<float>& now = ring_[last_];
  const bool near = phrases.pause() < PhraseTracker::kPause;
  now[kPitch] = near && frame.hz > 0
                    ? within(usual.log_hz.Above(std::log(static_cast<double>(frame.hz))))
                    : kForgets * pitch_before;
  now[kPower] = near ? within(usual.power_db.Above(static_cast<double>(frame.power_db))) : kSilent;
  now[kPosition] = phrases.position01();
  for (std::size_t i = kSounds; i < size_; ++i) {
    now[i] = i - kSounds < sounds.size() ? sounds[i - kSounds] : 0;
  }
}

Eigen::VectorXf HeadInputs::Vector(float emotion) const {
  Eigen::VectorXf vector(static_cast<Eigen::Index>(HeadNet::kInstants * size_ + 1));
  Eigen::Index at = 0;
  for (std::size_t i = 0; i < HeadNet::kInstants; ++i) {
    for (const float value : ring_[(last_ + kKept - i * HeadNet::kApart) % kKept]) {
      vector[at++] = value;
    }
  }
  vector[at] = emotion;
  return vector;
}

}  // namespace vdm
