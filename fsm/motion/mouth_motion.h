#pragma once

#include <array>

#include "fsm/motion/base/motion_source.h"
#include "vm_protocol/core/result.h"

namespace fsm {

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
