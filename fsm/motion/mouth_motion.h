#pragma once

#include <array>

#include "fsm/motion/base/motion_source.h"
#include "vm_protocol/core/result.h"

namespace fsm {

/// The value of each mouth parameter when Mouth.N is at 100 %: mm, for jaw Y degrees.
inline constexpr std::array<float, kMouthParameters> kMouthAtFull = {4, 4, 4,  4, -6, 4, -6, 4, 5,
                                                                     5, 5, 15, 4, 1,  1, 1,  1};

/// Moves the mouth by its parameters (slots Mouth.N), on the layer `mouth`.
class MouthMotion : public MotionSource {
 public:
  /// Moves a parameter, counted from 1, to `strength`. Errors: kBadValue for an unknown parameter,
  /// and for a strength outside 0..2.
  vm::Result<void> Set(vm::Time now, int parameter, double strength);

  void Contribute(vm::Time t, MotionLayers& layers) const override;

 protected:
  void ForEachTrack(const TrackVisitor& visit) const override;

 private:
  std::array<Track<float>, kMouthParameters> parameters_;
};

}  // namespace fsm
