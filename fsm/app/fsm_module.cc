#include "fsm/app/fsm_module.h"

#include <algorithm>

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

constexpr const char* kModuleVersion = "Module Ver. Galatea FSM " GALATEA_VERSION;
constexpr const char* kProtocolVersion =
    "Protocol Ver. 2.06";  // the last version of the original, which this protocol includes

}  // namespace

FsmModule::FsmModule(vm::Scheduler& clock, FaceView& view, FaceLibrary& library, MediaFiles files,
                     FsmOptions options)
    : options_(std::move(options)),
      core_{
          .clock = clock,
          .view = view,
          .faces = library,
          .files = std::move(files),
          .log = options_.log,
          .conventions = options_.config.path.empty() ? Conventions{} : Conventions::OfOriginal()} {
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
  core_.Add<MaskSlots>(options_.initial_face, options_.config.FaceNames());
  DeclareSceneSlots(core_);
  core_.Add<BackgroundSlots>(options_.config.backgrounds, options_.background);
  RecordSlots& record = core_.Add<RecordSlots>();
  core_.Add<WindowSlots>(record);
  core_.Add<PictureSlots>();
  core_.Add<CaptureSlots>();
  MakeFrameLoop(record, core_.Add<FrameSlots>(record));
  core_.notify_changed = [this] { Changed(); };
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
  for (const auto& group : core_.slot_groups) group->StopActivity();
  MakeMotion();
  ResetScene(core_);
  core_.slots.StoreInitialValues();
  for (const auto& group : core_.slot_groups) group->RestoreInitial();
  Changed();
}

std::vector<vm::Message> FsmModule::Greeting() {
  std::vector<vm::Message> lines = {vm::Rep("Run", "LIVE")};
  if (!options_.config.path.empty()) {  // as the original greets
    lines.push_back(vm::Tell("detected: -C flag: " + options_.config.path));
  }
  return lines;
}

// ---- time

void FsmModule::MakeFrameLoop(const RecordSlots& record, FrameSlots& frames) {
  const auto wanted = [this, &record, &frames]() -> std::optional<FrameLoop::Wanted> {
    if (core_.view.window() != nullptr) return FrameLoop::Wanted{frame_rate_, true};
    if (!frames.wanted()) return std::nullopt;
    return FrameLoop::Wanted{static_cast<double>(record.frames_per_second())};
  };
  frame_loop_.emplace(
      core_.clock,
      FrameLoop::Subject{
          .wanted = wanted,
          .next_motion =
              [this](vm::Time t) { return core_.view.Swings() ? t : core_.motion->NextMotion(t); },
          .rests_at =
              [this](vm::Time t) {
                return std::max(core_.motion->EndsAt(t), core_.motion->SettledAt(t));
              },
          .show =
              [this, &frames](vm::Time t) {
                if (!DrawInWindow(t)) return false;
                frames.ReportShown(t);
                return true;
              }});
}

void FsmModule::Changed() {
  for (const auto& group : core_.slot_groups) group->OnChange();
  frame_loop_->OnChange();
}

bool FsmModule::DrawInWindow(vm::Time now) {
  ViewWindow* const window = core_.view.window();
  if (window == nullptr) return true;
  if (auto drawn = core_.DrawAt(now); !drawn) {
    core_.slots.ReportError("", drawn.error());
    exit_requested_ = true;
    options_.on_failure();
    return false;
  }
  window->Show();
  if (window->close_requested()) exit_requested_ = true;
  return true;
}

bool FsmModule::Busy() const {
  return !frame_loop_->AtRest() ||
         std::ranges::any_of(core_.slot_groups, [](const auto& group) { return group->Busy(); });
}

void FsmModule::Shutdown() {
  // The runtime runs due timers before it ends. If drawing takes longer than the interval between
  // pictures, a capture would always have another one due.
  for (const auto& group : core_.slot_groups) group->StopActivity();
  frame_loop_->Stop();
}

}  // namespace fsm
