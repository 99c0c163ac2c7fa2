#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "vdm/net/mouth_net.h"

namespace vdm {

/// The mouth at one instant, as the face takes it: the 17 mouth parameters at full articulation
/// (mm on a mouth 50 mm wide, jaw in degrees; docs/face.md), the sealing of the lips and the height
/// of the tongue's tip, 0 .. 1, and how likely each class of sounds is.
struct MouthFrame {
  std::array<float, kMouthParameters> mouth{};
  float seal = 1;
  float tongue = 0;
  std::vector<float> sounds;  ///< beside MouthNet::sounds; sum 1

  /// About how far the inner lips are apart, in mm at full articulation: what lips and jaw (1.4 mm
  /// a degree) give, unless they are sealed.
  float Opening() const;
};

/// What a column of outputs means. Lips are sealed where the closure is more likely than not, with
/// a short way between, and all of the mouth rests then in what is no sound.
MouthFrame FrameOf(const MouthNet& net, const Eigen::Ref<const Eigen::VectorXf>& outputs);

/// The mouth of one network's outputs after the other, which decides what one instant cannot tell:
/// - A closure of p, b or m that has begun lasts a while, with the lips pressed, until it is
///   unlikely or a vowel is heard; its likelihood is often high for a frame or two alone.
/// - In silence the mouth waits before it goes home, and goes slowly: the silence of a stop such as
///   k is short, and lips that shut in it look like a p.
/// Lifetime: the network outlives it. Thread: none of its own; one instance, one thread.
class MouthMotion {
 public:
  MouthMotion(const MouthNet& net, double hop_ms);
  MouthFrame Next(const Eigen::Ref<const Eigen::VectorXf>& outputs);

 private:
  void Press(MouthFrame& frame, float closed);
  void Wait(MouthFrame& frame);

  const MouthNet& net_;
  const double hop_ms_;
  std::size_t closures_, first_vowel_;  // indices into frame.sounds; its size if there are none
  double pressed_ms_ = -1;              // since a closure was decided; -1: none is
  double silent_ms_ = 0;
  std::optional<MouthFrame> last_{};
};

}  // namespace vdm
