#include "fsm/motion/mouth_motion.h"

#include "fsm/motion/base/layer_names.h"
#include "fsm/motion/base/motion_errors.h"

namespace fsm {
namespace {

constexpr vm::Time kMove = std::chrono::milliseconds(60);

}  // namespace

vm::Result<void> MouthMotion::Set(vm::Time now, int parameter, double strength) {
  if (auto fits = CheckStrength(strength); !fits) return fits;
  const auto index = static_cast<std::size_t>(parameter - 1);
  if (parameter < 1 || index >= kMouthParameters) {
    return vm::Fail(vm::Errc::kBadValue, fmt::format("{} is no mouth parameter; 1 to {} expected",
                                                     parameter, kMouthParameters));
  }
  parameters_[index].MoveTo(now, static_cast<float>(strength) * kMouthAtFull[index], kMove);
  return {};
}

void MouthMotion::Contribute(vm::Time t, MotionLayers& layers) const {
  MotionLayer& layer = layers.Layer(LayerName::kMouth);
  for (std::size_t i = 0; i < kMouthParameters; ++i) layer.mouth[i] = parameters_[i].At(t);
  layer.mouth_by_hand = layer.mouth;
}

void MouthMotion::ForEachTrack(const TrackVisitor& visit) const {
  for (const auto& track : parameters_) visit(track);
}

}  // namespace fsm
