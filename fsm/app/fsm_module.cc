#include "fsm/app/fsm_module.h"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <iostream>

#include "fsm/app/expression_slots.h"
#include "fsm/app/face_slots.h"
#include "fsm/app/idle_slots.h"
#include "fsm/app/lip_slots.h"
#include "fsm/app/mouth_stream_slots.h"
#include "vm_protocol/core/or_throw.h"

namespace fsm {
namespace {

constexpr vm::Time kWindowEvents = std::chrono::milliseconds(200);
constexpr const char* kModuleVersion = "Module Ver. Galatea FSM " GALATEA_VERSION;
constexpr const char* kProtocolVersion =
    "Protocol Ver. 2.06";  // the original's last, which this one contains

}  // namespace

FsmModule::FsmModule(vm::Scheduler& clock, RenderBackend& backend, FsmOptions options)
    : options_(std::move(options)),
      core_{.clock = clock, .backend = backend, .original = !options_.config.path.empty()} {
  tables_ = vm::OrThrow(MotionTables::Load(options_.tables));
  ApplyConfig(options_.config);
  core_.changed = [this] { Changed(); };
  MakeMotion();
  vm::DeclareCommonSlots(core_.slots, {.module_version = kModuleVersion,
                                       .protocol_version = kProtocolVersion,
                                       .report_exit = false,
                                       .on_init = [this] { Initialise(); },
                                       .on_exit = [this] { exit_requested_ = true; }});
  DeclareFaceSlots(core_);
  DeclareExpressionSlots(core_);
  DeclareIdleSlots(core_);
  speech_ = std::make_unique<SpeechSlots>(
      core_, SpeechSlots::Listener{.begun = [this](vm::Time start) { capture_->Begin(start); },
                                   .ended =
                                       [this] {
                                         // On a busy machine the end is noticed late.
                                         const vm::Time now = core_.Now();
                                         capture_->End(std::min(
                                             now, core_.motion->speech.End().value_or(now)));
                                       }});
  DeclareLipSlots(core_);
  DeclareMouthStreamSlots(core_);
  DeclareFigureSlots(core_);
  mask_ = std::make_unique<MaskSlots>(core_, options_.mask, options_.config.MaskNames());
  scene_ = std::make_unique<SceneSlots>(core_, options_.config.backgrounds, options_.background);
  scene_->set_size_locked([this] { return film_->recording(); });
  MakeFilms();
  DeclareRecording();
  DeclarePictures();
  DeclareCapture();
  DeclareFrame();
  vm::OrThrow(BeginLife());
  core_.declared_at_start = core_.initial_values.size();
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

void FsmModule::MakeFilms() {
  const auto draw = [this](long number, vm::Time at) { return DrawFrame(number, at); };
  film_ = std::make_unique<FilmRecorder>(core_.clock, core_.backend, draw,
                                         [this](const vm::Error& error) {
                                           core_.slots.Report("Record", "STOP");
                                           core_.slots.ReportError("Record", error);
                                         });
  capture_ = std::make_unique<Capture>(core_.clock, core_.backend, draw,
                                       [this](const vm::Result<void>& done) {
                                         core_.slots.Report("Capture", "DISABLE");
                                         if (!done) {
                                           core_.slots.ReportError("Capture", done.error());
                                         }
                                       });
  pictures_ = std::make_unique<PictureStream>(
      core_.clock, core_.backend, [this](vm::Time at) { return core_.DrawAt(at); },
      [this](vm::Time from, vm::Time to) {
        return core_.backend.Swings() ||
               core_.motion->NextActivity(from).value_or(to + vm::Time(1)) <= to;
      },
      [this](const vm::Error& error) { core_.slots.ReportError("Picture.to", error); });
}

void FsmModule::MakeMotion() {
  core_.motion = std::make_unique<FaceMotion>(tables_, options_.seed);
  core_.motion->Apply(core_.Now(), start_settings_);
}

vm::Result<void> FsmModule::BeginLife() {
  if (options_.life.empty()) return {};
  if (auto set = core_.motion->idle.SetProfile(core_.Now(), options_.life); !set) return set;
  core_.slots.Store("Life", options_.life);
  return {};
}

void FsmModule::Initialise() {
  core_.slots.Store("Error", "");
  // A film shows the face as it was until now, with the sound named until now.
  if (film_->recording()) {
    if (auto stopped = StopFilm(); !stopped) core_.slots.ReportError("Record", stopped.error());
  }
  capture_->Cancel();
  core_.slots.Store("Capture", "DISABLE");
  static_cast<void>(pictures_->SendTo("NONE", 1));
  core_.slots.Store("Picture.to", "NONE");
  MakeMotion();
  speech_->Reset();
  core_.ForgetSlotsSinceStart();
  for (const auto& [name, value] : core_.initial_values) core_.slots.Store(name, value);
  mask_->Reset();
  scene_->Reset();
  if (auto set = BeginLife(); !set) core_.slots.ReportError("Life", set.error());
  frames_shown_ = 0;
  core_.slots.Store("Frame", "");
  unmeasured_mask_.reset();
  frame_to_.clear();
  Changed();
}

std::vector<vm::Message> FsmModule::Greeting() {
  std::vector<vm::Message> lines = {vm::Rep("Run", "LIVE")};
  if (options_.announce_config) {
    lines.push_back(vm::Tell("detected: -C flag: " + options_.config.path));
  }
  return lines;
}

// ---- films, captures, frames

void FsmModule::DeclareRecording() {
  core_.Declare(
      {.name = "Record.sound",
       .grammar = "<text>",
       .help = "A WAV file that becomes the film's sound when it is stopped; empty = silent.",
       .action = [](const vm::SetValue&) -> vm::Result<void> { return {}; }});
  core_.Declare({.name = "Record.fps",
                 .grammar = "<int 1..120>",
                 .help = "Frames a second of films and of Frame reports.",
                 .action = [](const vm::SetValue&) -> vm::Result<void> { return {}; },
                 .initial = "30"});
  core_.slots.Declare({.name = "Record.start",
                       .grammar = "<text>",
                       .access = vm::Access::kReadOnly,
                       .help = "The instant of the film's first frame, in ms on this process's "
                               "clock; frame k shows the face k / Record.fps seconds later. Empty "
                               "while there is no film.",
                       .on_inq = [this]() -> std::string {
                         return film_->recording() ? vm::FormatMs(film_->start()) : "";
                       }});
  core_.slots.Declare(
      {.name = "Record",
       .grammar = "STOP | <file>",
       .initial = "STOP",
       .help = "Records a film from now on: .mp4; .mov or .webm, which keep what is transparent; "
               ".mkv, which loses nothing; or "
               ".rgba, width * height * 4 bytes a frame, into a file or a named pipe that is being "
               "read. STOP ends it, and answers when it is there.",
       .on_set = [this](const vm::SetValue& value) -> vm::Result<std::string> {
         if (value.word(0) == "STOP") return StopFilm();
         const int rate = std::stoi(core_.slots.Value("Record.fps"));
         if (auto started = film_->Start(value.word(0), rate); !started) {
           return std::unexpected(started.error());
         }
         Changed();
         return value.word(0);
       },
       .saved = false});
}

void FsmModule::DeclarePictures() {
  core_.Declare({.name = "Picture.fps",
                 .grammar = "<int 1..60>",
                 .help = "Pictures a second of what Picture.to asks for, from its next setting on.",
                 .action = [](const vm::SetValue&) -> vm::Result<void> { return {}; },
                 .initial = "25"});
  core_.slots.Declare(
      {.name = "Picture.to",
       .grammar = "NONE | <file>",
       .initial = "NONE",
       .help = "unix:PATH of a socket that somebody listens at: gets pictures of the face with "
               "their times, beside any film (docs/face.md). NONE: no longer.",
       .on_set = [this](const vm::SetValue& value) -> vm::Result<std::string> {
         const int rate = std::stoi(core_.slots.Value("Picture.fps"));
         if (auto sent = pictures_->SendTo(value.word(0), rate); !sent) {
           return std::unexpected(sent.error());
         }
         return value.word(0);
       },
       .on_inq = [this] { return pictures_->to(); },
       .saved = false});
}

vm::Result<std::string> FsmModule::StopFilm() {
  const auto report = film_->Stop(core_.slots.Value("Record.sound"));
  core_.slots.Store("Record", "STOP");
  Changed();
  if (!report) return std::unexpected(report.error());
  std::cerr << fmt::format("fsm: {}: {} frames, {} of them repeated because drawing was late\n",
                           report->path, report->frames, report->repeated);
  return "STOP";
}

void FsmModule::DeclareCapture() {
  core_.slots.Declare(
      {.name = "Capture",
       .grammar = "STOP | <word> <word> <number 0.1..120> [ BMP | PNG ]",
       .initial = "DISABLE",
       .help =
           "Numbered pictures of the next utterance, from Speak = NOW to its end: folder, "
           "prefix, pictures a second. Its value is ENABLE until they are made, else DISABLE. At "
           "most 36000 of them and 8 GiB.",
       .on_set = [this](const vm::SetValue& value) -> vm::Result<std::string> {
         if (value.word(0) == "STOP" && value.size() == 1) {
           capture_->Cancel();
           return "DISABLE";
         }
         if (capture_->running()) {
           return vm::Fail(vm::Errc::kBusy, "pictures are being captured; wait for IDLE");
         }
         std::error_code code;
         std::filesystem::create_directories(value.word(0), code);
         if (!std::filesystem::is_directory(value.word(0), code)) {
           return vm::Fail(vm::Errc::kUnavailable,
                           "'" + value.word(0) + "' is not a folder and cannot be made one");
         }
         const bool png = value.size() > 3 && value.word(3) == "PNG";
         capture_->Arm({value.word(0), value.word(1), value.number(2), png ? ".png" : ".bmp"});
         return "ENABLE";
       },
       .saved = false});
}

void FsmModule::DeclareFrame() {
  core_.slots.Declare({.name = "Frame",
                       .grammar = "<text>",
                       .access = vm::Access::kReadOnly,
                       .help =
                           "The frame drawn last: NUMBER TIME_MS PHONEME JAW_DEG GAP_MM WIDTH_MM. "
                           "With AutoOutput every frame is reported; the number counts from 0 in "
                           "a film."});
  core_.Declare(
      {.name = "Frame.to",
       .grammar = "NONE | <word>",
       .help =
           "The module that is told each frame, by its slot FaceFrame, while something moves: "
           "TIME_MS on this module's clock, 17 mouth parameters, SEAL, TONGUE, the head's DOWN "
           "RIGHT TILT, DOWN RIGHT of the left and of the right eye in degrees, how far the left "
           "and the right lids are closed, then UNIT:STRENGTH of every action unit that is not at "
           "rest (12L:0.7).",
       .action = [this](const vm::SetValue& value) -> vm::Result<void> {
         const std::string name = value.word(0);
         if (name != "NONE" && !vm::IsModuleName(name)) {
           return vm::Fail(vm::Errc::kBadValue, "'" + name + "' is no name of a module");
         }
         frame_to_ = name == "NONE" ? "" : name;
         TellFrame(core_.Now());
         return {};
       },
       .initial = "NONE"});
}

void FsmModule::TellFrame(vm::Time at) {
  if (frame_to_.empty()) return;
  const FaceState state = core_.motion->StateAt(at);
  std::string text = vm::FormatMs(at);
  const auto add = [&text](float value) { text += fmt::format(" {:.4g}", value); };
  for (const float value : state.mouth) add(value);
  add(state.lip_seal);
  add(state.tongue);
  for (const float angle : state.head_rotation) add(angle);
  for (const float angle : state.gaze.left) add(angle);
  for (const float angle : state.gaze.right) add(angle);
  add(state.blink.left);
  add(state.blink.right);
  for (const auto& [units, side] : {std::pair(&state.au.left, 'L'), {&state.au.right, 'R'}}) {
    for (std::size_t unit = 0; unit < units->size(); ++unit) {
      if (std::abs((*units)[unit]) < 0.002F) continue;
      text += fmt::format(" {}{}:{:.3g}", unit, side, (*units)[unit]);
    }
  }
  core_.slots.Say(vm::To(frame_to_, vm::Set("FaceFrame", text)));
}

void FsmModule::ReportFrame(long number, vm::Time at) {
  if (!core_.slots.AutoOutput("Frame")) return;
  // A head that cannot be made is one error, not one for each frame; another may be worn later.
  const std::string worn = core_.slots.Value("Mask");
  if (worn == unmeasured_mask_) return;
  const FaceState state = core_.motion->StateAt(at);
  const auto mouth = core_.backend.Measure(state);
  if (!mouth) {
    unmeasured_mask_ = worn;
    return core_.slots.ReportError("Frame", mouth.error());
  }
  const std::string& phoneme = core_.motion->speech.PhonemeAt(at);
  core_.slots.Report("Frame", fmt::format("{} {} {} {:.2f} {:.2f} {:.2f}", number, vm::FormatMs(at),
                                          phoneme.empty() ? "-" : phoneme, mouth->jaw_degrees,
                                          mouth->gap_mm, mouth->width_mm));
}

vm::Result<void> FsmModule::DrawFrame(long number, vm::Time at) {
  auto drawn = core_.DrawAt(at);
  if (drawn) ReportFrame(number, at);
  return drawn;
}

// ---- time

void FsmModule::Changed() {
  if (pictures_) pictures_->Touch();
  ArmFrames();
  ArmEnd();
}

vm::Time FsmModule::FrameAfter(vm::Time t) const {
  // Frames without a film stand on a grid of the clock, so the same input gives the same reports.
  const double rate =
      core_.backend.has_window() ? frame_rate_ : std::stod(core_.slots.Value("Record.fps"));
  const FrameSeries grid{vm::Time(0), rate};
  auto k = static_cast<long>(std::floor(static_cast<double>(t.count()) * rate / 1e6));
  while (grid.TimeOf(k) <= t) ++k;
  return grid.TimeOf(k);
}

void FsmModule::ArmFrames() {
  const bool window = core_.backend.has_window();
  const bool reported =
      core_.slots.Has("Frame") && core_.slots.AutoOutput("Frame") && !film_->recording();
  const bool wanted = window || reported || !frame_to_.empty();
  const vm::Time now = core_.Now();
  std::optional<vm::Time> due;
  if (wanted) {
    // What has just been said is shown at the next frame, even if it moves nothing by itself.
    const auto active = core_.backend.Swings() ? now : core_.motion->NextActivity(now);
    if (active) due = FrameAfter(std::max(now, *active));
    if (window) due = std::min(due.value_or(now + kWindowEvents), now + kWindowEvents);
  }
  if (!due) return frame_timer_.Cancel();
  if (frame_timer_.pending() && *due == frame_due_) return;
  frame_due_ = *due;
  frame_timer_.At(*due, [this] { OnFrame(); });
}

void FsmModule::OnFrame() {
  const vm::Time now = core_.Now();
  if (core_.backend.has_window()) {
    if (auto drawn = core_.DrawAt(now); !drawn) {
      core_.slots.ReportError("", drawn.error());
      exit_requested_ = true;
      options_.on_failure();
      return;
    }
    core_.backend.Show();
    if (core_.backend.close_requested()) exit_requested_ = true;
  }
  if (!film_->recording()) ReportFrame(frames_shown_++, now);
  TellFrame(now);
  ArmFrames();
}

vm::Time FsmModule::BusyUntil() const {
  const vm::Time now = core_.Now();
  return std::max(core_.motion->FiniteEnd(now), core_.motion->OnsetsSettled(now));
}

void FsmModule::ArmEnd() {
  // A timer stands at the end of what moves: whoever waits for it is woken then, and the virtual
  // clock only goes to times at which there is a timer.
  const vm::Time end = BusyUntil();
  if (end_timer_.pending() && end == end_due_) return;
  if (end <= core_.Now()) return end_timer_.Cancel();
  end_due_ = end;
  end_timer_.At(end, [this] { ArmEnd(); });
}

bool FsmModule::Busy() const {
  return speech_->Busy() || capture_->running() || BusyUntil() > core_.Now();
}

void FsmModule::Shutdown() {
  // The runtime calls what is still due before it ends. Where drawing takes longer than the time
  // between two pictures, a capture would always have a next one due.
  capture_->Cancel();
  static_cast<void>(pictures_->SendTo("NONE", 1));
  frame_timer_.Cancel();
  if (!film_->recording()) return;
  if (auto stopped = StopFilm(); !stopped) core_.slots.ReportError("Record", stopped.error());
}

}  // namespace fsm
