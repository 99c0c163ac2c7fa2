#include "fsm/app/fsm_module.h"

#include <algorithm>
#include <cmath>

#include "fsm/app/background_slots.h"
#include "fsm/app/capture_slots.h"
#include "fsm/app/expression_slots.h"
#include "fsm/app/face_slots.h"
#include "fsm/app/idle_slots.h"
#include "fsm/app/lip_slots.h"
#include "fsm/app/mask_slots.h"
#include "fsm/app/mouth_stream_slots.h"
#include "fsm/app/picture_slots.h"
#include "fsm/app/scene_slots.h"
#include "fsm/app/speech_slots.h"
#include "fsm/app/window_slots.h"
#include "vm_protocol/core/or_throw.h"

namespace fsm {
namespace {

constexpr vm::Time kWindowEvents = std::chrono::milliseconds(200);
constexpr const char* kModuleVersion = "Module Ver. Galatea FSM " GALATEA_VERSION;
constexpr const char* kProtocolVersion =
    "Protocol Ver. 2.06";  // the last version of the original, which this protocol includes

}  // namespace

FsmModule::FsmModule(vm::Scheduler& clock, FaceView& view, Wardrobe& wardrobe, MediaFiles files,
                     FsmOptions options)
    : options_(std::move(options)),
      core_{.clock = clock,
            .view = view,
            .wardrobe = wardrobe,
            .files = std::move(files),
            .log = options_.log,
            .original = !options_.config.path.empty()} {
  tables_ = vm::OrThrow(MotionTables::Load(options_.tables));
  ApplyConfig(options_.config);
  MakeMotion();
  vm::DeclareCommonSlots(core_.slots, {.module_version = kModuleVersion,
                                       .protocol_version = kProtocolVersion,
                                       .report_exit = false,
                                       .on_init = [this] { Initialise(); },
                                       .on_exit = [this] { exit_requested_ = true; }});
  DeclareFaceSlots(core_);
  core_.Add<ExpressionSlots>();
  DeclareIdleSlots(core_, options_.life);
  core_.Add<SpeechSlots>();
  DeclareLipSlots(core_);
  DeclareMouthStreamSlots(core_);
  DeclareFigureSlots(core_);
  core_.Add<MaskSlots>(options_.mask, options_.config.MaskNames());
  DeclareSceneSlots(core_);
  core_.Add<BackgroundSlots>(options_.config.backgrounds, options_.background);
  record_ = &core_.Add<RecordSlots>();
  core_.Add<WindowSlots>(*record_);
  core_.Add<PictureSlots>();
  core_.Add<CaptureSlots>();
  frames_ = &core_.Add<FrameSlots>();
  core_.changed = [this] { Changed(); };
  Changed();
}

void FsmModule::ApplyConfig(const OriginalConfig& config) {
  vm::OrThrow(config.ApplyTo(tables_));
  if (config.expression_ms) {
    start_settings_.onset = Onset::kFixed;
    start_settings_.expression = FromMs(*config.expression_ms);
  }
  if (config.eye_move_ms) start_settings_.eye_move = FromMs(*config.eye_move_ms);
  if (config.language) start_settings_.lips.language = *config.language;
  if (config.max_frame_rate) frame_rate_ = *config.max_frame_rate;
}

void FsmModule::MakeMotion() {
  core_.motion = std::make_unique<FaceMotion>(tables_, options_.seed);
  core_.motion->Apply(core_.Now(), start_settings_);
  vm::OrThrow(core_.motion->switches().SetProfile(core_.Now(), options_.life));
}

void FsmModule::Initialise() {
  core_.slots.Store("Error", "");
  // Films end first, with the face and the sound file from before INIT.
  for (const auto& part : core_.parts) part->End();
  MakeMotion();
  ResetScene(core_);
  core_.slots.StoreInitialValues();
  for (const auto& part : core_.parts) part->Reset();
  Changed();
}

std::vector<vm::Message> FsmModule::Greeting() {
  std::vector<vm::Message> lines = {vm::Rep("Run", "LIVE")};
  if (core_.original) {  // as the original greets
    lines.push_back(vm::Tell("detected: -C flag: " + options_.config.path));
  }
  return lines;
}

// ---- time

void FsmModule::Changed() {
  changed_ = true;
  for (const auto& part : core_.parts) part->OnChange();
  ArmFrames();
  ArmEnd();
}

vm::Time FsmModule::FrameAfter(vm::Time t) const {
  // Frames outside a film are on a fixed grid of the clock, so that the same input gives the same
  // reports.
  const bool shown = core_.view.window() != nullptr;
  const double rate = shown ? frame_rate_ : record_->frames_per_second();
  const FrameSeries grid{vm::Time(0), rate};
  auto k = static_cast<long>(std::floor(static_cast<double>(t.count()) * rate / 1e6));
  while (grid.TimeOf(k) <= t) ++k;
  return grid.TimeOf(k);
}

void FsmModule::ArmFrames() {
  const bool window = core_.view.window() != nullptr;
  const bool reported = frames_->is_reported() && !record_->recording();
  const bool wanted = window || reported || frames_->is_sent();
  const vm::Time now = core_.Now();
  std::optional<vm::Time> due;
  if (wanted) {
    const auto active = core_.view.Swings() ? now : core_.motion->NextActivity(now);
    if (active) due = FrameAfter(std::max(now, *active));
    // The effect of a command is shown in the next frame, even if nothing moves by it, and
    // commands do not put off a frame that is due already.
    if (changed_) {
      due = FrameAfter(now);
    } else if (window) {
      due = std::min(due.value_or(vm::Time::max()), now + kWindowEvents);
    }
    if (due && frame_timer_.pending()) due = std::min(*due, frame_due_);
  }
  if (!due) return frame_timer_.Cancel();
  if (frame_timer_.pending() && *due == frame_due_) return;
  frame_due_ = *due;
  frame_timer_.At(*due, [this] { OnFrame(); });
}

void FsmModule::OnFrame() {
  const vm::Time now = core_.Now();
  if (ViewWindow* const window = core_.view.window()) {
    if (auto drawn = core_.DrawAt(now); !drawn) {
      core_.slots.ReportError("", drawn.error());
      exit_requested_ = true;
      options_.on_failure();
      return;
    }
    window->Show();
    if (window->close_requested()) exit_requested_ = true;
  }
  changed_ = false;
  if (!record_->recording()) frames_->ReportShown(now);
  frames_->SendState(now);
  ArmFrames();
}

vm::Time FsmModule::BusyUntil() const {
  const vm::Time now = core_.Now();
  return std::max(core_.motion->FiniteEnd(now), core_.motion->OnsetsSettled(now));
}

void FsmModule::ArmEnd() {
  // Set a timer at the end of all movement: it wakes those who wait for that, and the virtual clock
  // only advances to times of timers.
  const vm::Time end = BusyUntil();
  if (end_timer_.pending() && end == end_due_) return;
  if (end <= core_.Now()) return end_timer_.Cancel();
  end_due_ = end;
  end_timer_.At(end, [this] { ArmEnd(); });
}

bool FsmModule::Busy() const {
  return BusyUntil() > core_.Now() ||
         std::ranges::any_of(core_.parts, [](const auto& part) { return part->Busy(); });
}

void FsmModule::Shutdown() {
  // The runtime runs due timers before it ends. If drawing takes longer than the interval between
  // pictures, a capture would always have another one due.
  for (const auto& part : core_.parts) part->End();
  frame_timer_.Cancel();
}

}  // namespace fsm
