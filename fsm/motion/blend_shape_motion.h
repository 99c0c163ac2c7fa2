#pragma once

#include <map>
#include <string>
#include <string_view>

#include "fsm/motion/motion_source.h"
#include "vm_protocol/core/result.h"

namespace fsm {

/// Blend shapes by ARKit's names, on the layer `blend_shapes`. The table outlives it.
class BlendShapeMotion : public MotionSource {
 public:
  explicit BlendShapeMotion(const BlendShapes& shapes) : shapes_(shapes) {}

  /// kBadValue with what there is.
  vm::Result<void> Check(std::string_view name) const;
  /// kBadValue as Check, and for a weight outside 0..2.
  vm::Result<void> Set(vm::Time now, std::string_view name, double weight, vm::Time move);

  void Contribute(vm::Time t, MotionLayers& layers) const override;

 protected:
  void ForEachTrack(const TrackVisitor& visit) const override;

 private:
  const BlendShapes& shapes_;
  std::map<std::string, Track<float>, std::less<>> weights_;  // of those ever set
};

}  // namespace fsm
