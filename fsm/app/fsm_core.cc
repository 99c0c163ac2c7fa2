#include "fsm/app/fsm_core.h"

namespace fsm {

vm::Result<void> FsmCore::DrawAt(vm::Time t) {
  const FaceView::StateHistory history{t, [this](vm::Time at) { return motion->StateAt(at); }};
  return view.Draw(motion->StateAt(t), scene, simulates ? &history : nullptr);
}

vm::Result<void> FsmCore::DrawFrame(long number, vm::Time t) {
  if (auto drawn = DrawAt(t); !drawn) return drawn;
  for (const auto& part : parts) part->OnFrame(number, t);
  return {};
}

void FsmCore::ClampNumbers(vm::SetValue& value, int least, int most) {
  value.text.clear();
  for (auto& item : value.items) {
    if (item.number < least || item.number > most) {
      const int nearest = item.number < least ? least : most;
      item.number = nearest;
      item.text = std::to_string(nearest);
    }
    value.text += (value.text.empty() ? "" : " ") + item.text;
  }
}

}  // namespace fsm
