#pragma once

#include <cstdint>

#include "vdm/prosody/head_inputs.h"

namespace vdm {

/// A low-pass filter of two equal poles for what a network says of a head each 10 ms: it makes
/// movements smooth and about 40 ms later. A plain value.
class HeadFilter {
 public:
  HeadPose Add(const HeadPose& pose);

 private:
  HeadPose once_{}, twice_{};
};

/// What the network says of its inputs, before anything else.
HeadPose PoseOf(const HeadNet& net, const Eigen::VectorXf& inputs);

/// Prosody in, the head out, each 10 ms: what the network says and a pose that each phrase has by
/// chance, made smooth by a filter of two equal poles. In no speech the head goes home within
/// kReturns and stays there; where it is not sure that there is speech it does not begin.
/// Lifetime: the network outlives it. Thread: none of its own; one instance, one thread.
class HeadMover {
 public:
  static constexpr int kRest = 30;       ///< hops without speech after which the head goes home
  static constexpr int kReturns = 70;    ///< hops it takes
  static constexpr int kBegins = 30;     ///< hops from rest into movement
  static constexpr int kPoseTakes = 52;  ///< hops to the pose of a new phrase

  explicit HeadMover(const HeadNet& net, std::uint64_t seed = 1)
      : net_(net), seed_(seed), inputs_(net.sounds) {}

  /// REQUIRES: `usual` and `phrases` have taken the frame already. `emotion`: 0 .. 1; `size`: a
  /// factor of all of it.
  HeadPose Add(const ProsodyFrame& frame, const SpeakerUsual& usual, const PhraseTracker& phrases,
               const std::vector<float>& sounds, float emotion, float size);

 private:
  using Pose = std::array<float, 3>;
  Pose PhrasePose(const PhraseTracker& phrases);

  const HeadNet& net_;
  const std::uint64_t seed_;
  HeadInputs inputs_;
  Pose pose_from_{}, pose_to_{};
  int pose_since_ = kPoseTakes;
  float moves_ = 0;  // 0 at rest .. 1
  HeadFilter filter_;
};

}  // namespace vdm
