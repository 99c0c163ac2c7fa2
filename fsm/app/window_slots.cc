#include "fsm/app/window_slots.h"

namespace fsm {

WindowSlots::WindowSlots(FsmCore& core, const RecordSlots& record)
    : core_(core), start_width_(core_.view.width()), start_height_(core_.view.height()) {
  core_.slots.Declare(
      {.name = "Window",
       .grammar = "FULLSCREEN | WINDOWED | <int 16..8192> <int 16..8192>",
       .initial = std::to_string(start_width_) + " " + std::to_string(start_height_),
       .help =
           "Width and height of the view in pixels; or the window fills the screen, or no more.",
       .on_set = core_.Command([this, &record](const vm::SetValue& value) -> vm::Result<void> {
         if (record.recording()) {
           return vm::Fail(vm::Errc::kBusy,
                           "a film of this size is recorded; set Record = STOP first");
         }
         if (value.size() == 1) return FillScreen(value.word(0) == "FULLSCREEN");
         return core_.view.Resize(static_cast<int>(value.number(0)),
                                  static_cast<int>(value.number(1)));
       })});
}

vm::Result<void> WindowSlots::FillScreen(bool fill) {
  ViewWindow* const window = core_.view.window();
  if (window == nullptr) {
    return vm::Fail(vm::Errc::kUnavailable, "there is no window to fill the screen with");
  }
  window->FillScreen(fill);
  fills_screen_ = fill;
  return {};
}

void WindowSlots::RestoreInitial() {
  vm::Result<void> done;
  if (fills_screen_) done = FillScreen(false);
  if (done) done = core_.view.Resize(start_width_, start_height_);
  if (!done) core_.slots.ReportError("Window", done.error());
}

}  // namespace fsm
