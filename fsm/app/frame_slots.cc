#include "fsm/app/frame_slots.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "vm_protocol/core/module.h"

namespace fsm {

FrameSlots::FrameSlots(FsmCore& core, const RecordSlots& record) : core_(core), record_(record) {
  core_.slots.Declare({.name = "Frame",
                       .grammar = "<text>",
                       .access = vm::Access::kReadOnly,
                       .help =
                           "The frame drawn last: NUMBER TIME_MS PHONEME JAW_DEG GAP_MM WIDTH_MM. "
                           "With AutoOutput every frame is reported; the number counts from 0 in "
                           "a film."});
  core_.slots.Declare(
      {.name = "Frame.to",
       .grammar = "NONE | <word>",
       .initial = "NONE",
       .help =
           "The module that is told each frame, by its slot FaceFrame, while something moves: "
           "TIME_MS on this module's clock, 17 mouth parameters, SEAL, TONGUE, the head's DOWN "
           "RIGHT TILT, DOWN RIGHT of the left and of the right eye in degrees, how far the left "
           "and the right lids are closed, then UNIT:STRENGTH of every action unit that is not at "
           "rest (12L:0.7).",
       .on_set = core_.Command([this](const vm::SetValue& value) -> vm::Result<void> {
         const std::string name = value.word(0);
         if (name != "NONE" && !vm::IsModuleName(name)) {
           return vm::Fail(vm::Errc::kBadValue, "'" + name + "' is no name of a module");
         }
         to_ = name == "NONE" ? "" : name;
         SendState(core_.Now());
         return {};
       })});
}

void FrameSlots::ReportShown(vm::Time at) {
  if (!record_.recording()) Report(shown_++, at);
  SendState(at);
}

void FrameSlots::SendState(vm::Time at) {
  if (to_.empty()) return;
  const FaceState state = core_.motion->StateAt(at);
  std::string text = vm::FormatMs(at);
  const auto add = [&text](float value) { text += fmt::format(" {:.4g}", value); };
  for (const float value : state.mouth) add(value);
  add(state.seal);
  add(state.tongue);
  for (const float angle : state.head_rotation) add(angle);
  for (const float angle : state.gaze.left) add(angle);
  for (const float angle : state.gaze.right) add(angle);
  add(state.blink.left);
  add(state.blink.right);
  for (const auto& [units, side] : {std::pair(&state.au.left, 'L'), {&state.au.right, 'R'}}) {
    for (std::size_t unit = 0; unit < units->size(); ++unit) {
      if (std::abs((*units)[unit]) < 0.002f) continue;
      text += fmt::format(" {}{}:{:.3g}", unit, side, (*units)[unit]);
    }
  }
  core_.slots.Say(vm::To(to_, vm::Set("FaceFrame", text)));
}

void FrameSlots::Report(long number, vm::Time at) {
  if (!is_reported()) return;
  // Report a head that cannot be made once, not for each frame; the face may be changed later.
  const std::string worn = core_.slots.Value("Mask");
  if (worn == unmeasured_face_) return;
  const FaceState state = core_.motion->StateAt(at);
  const auto mouth = core_.faces.Measure(state);
  if (!mouth) {
    unmeasured_face_ = worn;
    return core_.slots.ReportError("Frame", mouth.error());
  }
  const std::string& phoneme = core_.motion->speech.PhonemeAt(at);
  core_.slots.Report("Frame", fmt::format("{} {} {} {:.2f} {:.2f} {:.2f}", number, vm::FormatMs(at),
                                          phoneme.empty() ? "-" : phoneme, mouth->jaw_degrees,
                                          mouth->gap_mm, mouth->width_mm));
}

void FrameSlots::RestoreInitial() {
  shown_ = 0;
  unmeasured_face_.reset();
  to_.clear();
}

}  // namespace fsm
