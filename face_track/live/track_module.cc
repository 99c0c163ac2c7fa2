#include "face_track/live/track_module.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace facetrack {

TrackModule::TrackModule(vm::Scheduler& scheduler, Options options)
    : scheduler_(scheduler),
      options_(std::move(options)),
      slots_("TRACK"),
      print_(FacePrint::Format::kJsonLines, {}, SeenFace::Shipped()),
      command_(SeenFace::Shipped()) {
  DeclareRun();
  DeclareSettings();
  DeclareTold();
}

void TrackModule::Shutdown() {
  tracker_.reset();
  if (home_timer_ != 0) scheduler_.Cancel(std::exchange(home_timer_, 0));
}

void TrackModule::DeclareRun() {
  vm::DeclareCommonSlots(slots_, {.module_version = options_.module_version,
                                  .protocol_version = "Galatea protocol 1.0",
                                  .auto_output = true,
                                  .on_start = [this]() -> vm::Result<void> {
                                    on_ = true;
                                    auto started = Start();
                                    on_ = started.has_value();
                                    return started;
                                  },
                                  .on_stop =
                                      [this] {
                                        on_ = false;
                                        Stop();
                                      },
                                  .work = "the face in Input is followed and moves the agent",
                                  .on_exit =
                                      [this] {
                                        on_ = false;
                                        Stop();
                                        exit_requested_ = true;
                                      }});
  slots_.Declare(
      {.name = "Input",
       .grammar = "NONE | <file>",
       .initial = "NONE",
       .auto_output = true,
       .help = "Where pictures come from: NONE, camera (/dev/video0), v4l2:DEVICE, ffmpeg:WORDS "
               "(any input of ffmpeg, as its command line has it), a film or a folder of pictures "
               "(once, at its own pace). It is followed while Run is START.",
       .on_set = [this](const vm::SetValue& value) -> vm::Result<std::string> {
         Stop();
         input_ = value.text;
         if (auto started = Start(); !started) {
           input_ = "NONE";
           return std::unexpected(started.error());
         }
         return input_;
       },
       .on_inq = [this] { return input_; },
       .saved = false});
}

void TrackModule::DeclareSettings() {
  slots_.Declare({.name = "Mirror",
                  .grammar = "ON | OFF",
                  .initial = "ON",
                  .help = "ON: the agent moves as one's image in a mirror does. OFF: as a person "
                          "who faces one: one's left is its left.",
                  .on_set = [this](const vm::SetValue& value) -> vm::Result<std::string> {
                    mirrored_ = value.word(0) == "ON";
                    return value.word(0);
                  }});
  slots_.Declare({.name = "Track.to",
                  .grammar = "NONE | <word>",
                  .initial = "FSM",
                  .help = "The module that is moved, by its slot AU.",
                  .on_set = [this](const vm::SetValue& value) -> vm::Result<std::string> {
                    if (!vm::IsModuleName(value.word(0))) {
                      return vm::Fail(vm::Errc::kBadValue,
                                      "'" + value.word(0) + "' is not a module's name");
                    }
                    GoHome();
                    face_ = value.word(0);
                    return face_;
                  }});
  const auto declare_number = [this](const char* name, const char* grammar, double initial,
                                     const char* help, std::function<void(double)> set) {
    slots_.Declare({.name = name,
                    .grammar = grammar,
                    .initial = fmt::format("{:g}", initial),
                    .help = help,
                    .on_set = [set](const vm::SetValue& value) -> vm::Result<std::string> {
                      set(value.number(0));
                      return value.word(0);
                    }});
  };
  declare_number("Field", "<number 5..120>", options_.tracker.field_degrees,
                 "Degrees the camera sees from below to above, for the next START.",
                 [this](double v) { options_.tracker.field_degrees = static_cast<float>(v); });
  declare_number("Settle", "<number 0..4000>", options_.tracker.settle_ms,
                 "How many ms of a person are taken for its rest, for the next START.",
                 [this](double v) { options_.tracker.settle_ms = v; });
  declare_number("Which", "<int 1..10>", static_cast<double>(options_.tracker.which),
                 "Which of several faces, 1 = the largest, for the next START.",
                 [this](double v) { options_.tracker.which = static_cast<std::size_t>(v); });
}

void TrackModule::DeclareTold() {
  slots_.DeclareTold("Track", "", "Each picture's line as a JSON object (docs/tracking.md).");
  slots_.DeclareTold("Track.stat", "OFF",
                     "OFF, LOOKING (for a face, or at one for the first time) or FOLLOWING.", true);
  slots_.DeclareTold(
      "Track.speed", "0 0",
      "Each second: how many pictures were looked at in it, and how many ms after it was there "
      "what one shows was told.");
}

vm::Result<void> TrackModule::Start() {
  if (!on_ || tracker_ || input_ == "NONE") return {};
  auto tracker =
      options_.open(input_, options_.tracker,
                    {.moment = [this](const LiveTracker::Moment& moment) { OnMoment(moment); },
                     .over =
                         [this](const std::optional<vm::Error>& error) {
                           if (error) slots_.ReportError("Input", *error);
                           Stop();
                           input_ = "NONE";
                           slots_.Report("Input", input_);
                         }});
  if (!tracker) return std::unexpected(tracker.error());
  tracker_ = std::move(*tracker);
  second_ = scheduler_.Now();
  pictures_ = 0;
  taken_ = {};
  Tell("LOOKING");
  return {};
}

void TrackModule::Stop() {
  if (!tracker_) return;
  tracker_.reset();
  GoHome();
  Tell("OFF");
}

void TrackModule::OnMoment(const LiveTracker::Moment& moment) {
  ++pictures_;
  taken_ += moment.taken;
  if (const vm::Time now = scheduler_.Now(); now - second_ >= vm::Time(1'000'000)) {
    const double seconds = static_cast<double>((now - second_).count()) / 1e6;
    slots_.Report("Track.speed",
                  fmt::format("{:.1f} {:.0f}", pictures_ / seconds,
                              static_cast<double>(taken_.count()) / 1000 / pictures_));
    second_ = now;
    pictures_ = 0;
    taken_ = {};
  }
  if (moment.lines.empty()) return;
  if (slots_.AutoOutput("Track")) {
    for (const FaceLine& line : moment.lines) {
      std::string text = print_.Line(line);
      text.pop_back();
      slots_.Report("Track", text);
    }
  }
  Show(moment.lines.back());
}

void TrackModule::Show(const FaceLine& line) {
  if (line.person == 0) {
    Tell("LOOKING");
    if (home_timer_ == 0) {
      home_timer_ = scheduler_.After(kHome, [this] {
        home_timer_ = 0;
        GoHome();
      });
    }
    return;
  }
  if (home_timer_ != 0) scheduler_.Cancel(std::exchange(home_timer_, 0));
  Tell("FOLLOWING");
  // The agent is where the person is when the next picture comes.
  constexpr double kLeast = 20, kMost = 120;
  const double ms = std::clamp(line.ms - std::exchange(last_ms_, line.ms), kLeast, kMost);
  TellFace(command_.Next(line, mirrored_, ms));
}

void TrackModule::GoHome() {
  constexpr double kGentlyMs = 500;
  TellFace(command_.Rest(kGentlyMs));
}

void TrackModule::TellFace(const std::string& units) {
  if (units.empty() || face_ == "NONE") return;
  slots_.Say(vm::To(face_, vm::Set("AU", units)));
}

void TrackModule::Tell(const std::string& stat) {
  if (stat == std::exchange(stat_, stat)) return;
  slots_.Report("Track.stat", stat);
}

}  // namespace facetrack
