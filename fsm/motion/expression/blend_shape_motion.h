#pragma once

#include <map>
#include <string>
#include <string_view>

#include "fsm/motion/base/motion_source.h"
#include "vm_protocol/core/result.h"

namespace fsm {

/// Moves the face by ARKit's blend shapes, on the layer `blend_shapes`. Lifetime: `shapes` outlives
/// this.
class BlendShapeMotion : public MotionSource {
 public:
  explicit BlendShapeMotion(const BlendShapes& shapes) : shapes_(shapes) {}

  /// Checks that a shape exists. Error: kBadValue listing the names.
  vm::Result<void> Check(std::string_view name) const;
  /// Moves the weight of a shape to `weight` (0..2, 1 = full) within `move`. Errors: kBadValue as
  /// Check, and for a weight out of range.
  vm::Result<void> Set(vm::Time now, std::string_view name, double weight, vm::Time move);

  void Contribute(vm::Time t, MotionLayers& layers) const override;

 protected:
  void ForEachTrack(const TrackVisitor& visit) const override;

 private:
  const BlendShapes& shapes_;
  std::map<std::string, Track<float>, std::less<>> weights_;  // of the shapes set so far
};

}  // namespace fsm
