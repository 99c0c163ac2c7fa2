#include "vdm/prosody/head_mover.h"

#include <algorithm>
#include <cmath>

namespace vdm {
namespace {

// Of each pole, for 10 ms: a time constant of 20 ms.
const float kKeeps = std::exp(-10.0F / 30.0F);

float Smooth(float u) { return u * u * u * (u * (6 * u - 15) + 10); }

/// -1 .. 1 by chance, of a thing and a number (SplitMix64: Steele, Lea and Flood, Fast splittable
/// pseudorandom number generators, 2014), with a deviation of 1/sqrt(3).
float Chance(std::uint64_t seed, std::uint64_t thing, std::uint64_t number) {
  std::uint64_t z = seed * 0x9E3779B97F4A7C15U + thing * 0xD1B54A32D192ED03U + number;
  for (int i = 0; i < 2; ++i) {
    z += 0x9E3779B97F4A7C15U;
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9U;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBU;
    z ^= z >> 31;
  }
  return static_cast<float>(static_cast<double>(z >> 11) * 0x1p-52 - 1);
}

}  // namespace

HeadPose HeadFilter::Add(const HeadPose& pose) {
  const auto towards = [](float& value, float wanted) {
    value = kKeeps * value + (1 - kKeeps) * wanted;
  };
  for (std::size_t i = 0; i < 3; ++i) {
    towards(once_.angles[i], pose.angles[i]);
    towards(twice_.angles[i], once_.angles[i]);
  }
  towards(once_.brow, pose.brow);
  towards(twice_.brow, once_.brow);
  return twice_;
}

HeadPose PoseOf(const HeadNet& net, const Eigen::VectorXf& inputs) {
  const Eigen::MatrixXf outputs = net.net.Outputs(inputs);
  HeadPose out;
  const auto value = [&](std::size_t i) {
    return net.means[i] + net.scales[i] * outputs(static_cast<Eigen::Index>(i), 0);
  };
  for (std::size_t i = 0; i < 3; ++i) out.angles[i] = value(i);
  out.brow = value(3);
  return out;
}

HeadMover::Pose HeadMover::PhrasePose(const PhraseTracker& phrases) {
  const float u = Smooth(static_cast<float>(pose_since_) / kPoseTakes);
  Pose now;
  for (std::size_t i = 0; i < 3; ++i) now[i] = pose_from_[i] + u * (pose_to_[i] - pose_from_[i]);
  pose_since_ = std::min(pose_since_ + 1, kPoseTakes);
  if (phrases.begins()) {
    pose_from_ = now;
    pose_since_ = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      pose_to_[i] = std::sqrt(3.0F) * net_.pose[i] * Chance(seed_, i, phrases.phrase());
    }
  }
  return now;
}

HeadPose HeadMover::Add(const ProsodyFrame& frame, const SpeakerUsual& usual,
                        const PhraseTracker& phrases, const std::vector<float>& sounds,
                        float emotion, float size) {
  inputs_.Add(frame, usual, phrases, sounds);
  const Pose pose = PhrasePose(phrases);
  if (phrases.pause() > kRest) {
    moves_ = std::max(0.0F, moves_ - 1.0F / kReturns);
  } else if (phrases.sure() || moves_ > 0) {
    moves_ = std::min(1.0F, moves_ + 1.0F / kBegins);
  }
  HeadPose wanted = PoseOf(net_, inputs_.Vector(emotion));
  for (std::size_t i = 0; i < 3; ++i) wanted.angles[i] += pose[i];
  HeadPose out = filter_.Add(wanted);
  const float weight = size * Smooth(moves_);
  for (float& angle : out.angles) angle *= weight;
  out.brow = std::clamp(weight * out.brow, 0.0F, 1.0F);
  return out;
}

}  // namespace vdm
