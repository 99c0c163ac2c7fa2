#include "fsm/motion/expression/mood_motion.h"

#include "fsm/motion/base/layer_names.h"
#include "fsm/motion/base/motion_errors.h"

namespace fsm {

vm::Result<void> MoodMotion::Set(vm::Time now, std::string_view name, double strength) {
  FaceLook look;
  if (name != "NEUTRAL") {
    const auto found = patterns_.moods.find(name);
    if (found == patterns_.moods.end()) {
      return vm::Fail(vm::Errc::kBadValue, fmt::format("'{}' is no mood; {} or NEUTRAL expected",
                                                       name, KeysOf(patterns_.moods)));
    }
    AddTo(look, found->second, static_cast<float>(strength));
  }
  look_.MoveTo(now, look, kTakes);
  return {};
}

void MoodMotion::Contribute(vm::Time t, MotionLayers& layers) const {
  layers.Layer(LayerName::kMood).look = look_.At(t);
}

}  // namespace fsm
