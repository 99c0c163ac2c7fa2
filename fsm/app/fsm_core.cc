#include "fsm/app/fsm_core.h"

namespace fsm {

Conventions Conventions::OfOriginal() {
  Conventions original{.tilt = -1, .lists_our_backgrounds = false};
  original.scene.camera.moves_by_half_views = true;
  original.scene.wire = glm::vec3(1);
  original.scene.wire_on_black = true;
  return original;
}

vm::Result<void> FsmCore::DrawAt(vm::Time t) {
  const FaceView::StateHistory history{t, [this](vm::Time at) { return motion->StateAt(at); }};
  return view.Draw(motion->StateAt(t), scene, simulates ? &history : nullptr);
}

vm::Result<void> FsmCore::DrawFrame(long number, vm::Time t) {
  if (auto drawn = DrawAt(t); !drawn) return drawn;
  for (const auto& group : slot_groups) group->OnFilmFrame(number, t);
  return {};
}

void FsmCore::ClampNumbers(vm::SetValue& value, int min, int max) {
  value.text.clear();
  for (auto& item : value.items) {
    if (item.number < min || item.number > max) {
      const int nearest = item.number < min ? min : max;
      item.number = nearest;
      item.text = std::to_string(nearest);
    }
    value.text += (value.text.empty() ? "" : " ") + item.text;
  }
}

}  // namespace fsm
