#include "fsm/motion/expression/blend_shape_motion.h"

#include "fsm/motion/base/layer_names.h"
#include "fsm/motion/base/motion_errors.h"

namespace fsm {

vm::Result<void> BlendShapeMotion::Check(std::string_view name) const {
  if (shapes_.contains(name)) return {};
  return vm::Fail(vm::Errc::kBadValue,
                  fmt::format("'{}' is no blend shape; there are {}", name, KeysOf(shapes_)));
}

vm::Result<void> BlendShapeMotion::Set(vm::Time now, std::string_view name, double weight,
                                       vm::Time move) {
  if (auto fits = CheckStrength(weight); !fits) return fits;
  if (auto known = Check(name); !known) return known;
  weights_[std::string(name)].MoveTo(now, static_cast<float>(weight), move);
  return {};
}

void BlendShapeMotion::Contribute(vm::Time t, MotionLayers& layers) const {
  FaceLook& look = layers.Layer(LayerName::kBlendShapes).look;
  for (const auto& [name, weight] : weights_) AddTo(look, shapes_.find(name)->second, weight.At(t));
}

void BlendShapeMotion::ForEachTrack(const TrackVisitor& visit) const {
  for (const auto& [name, weight] : weights_) visit(weight);
}

}  // namespace fsm
