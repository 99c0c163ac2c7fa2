#include "fsm/app/record_slots.h"

#include <fmt/format.h>

namespace fsm {

RecordSlots::RecordSlots(FsmCore& core)
    : core_(core),
      film_(
          core.clock, core.view, core.files,
          [this](long number, vm::Time at) { return core_.DrawFrame(number, at); },
          [this](const vm::Error& error) {
            core_.slots.Report("Record", "STOP");
            core_.slots.ReportError("Record", error);
          }) {
  core_.slots.Declare(
      {.name = "Record.sound",
       .grammar = "<text>",
       .help = "A WAV file that becomes the film's sound when it is stopped; empty = silent.",
       .on_set = core_.Command([](const vm::SetValue&) {})});
  core_.slots.Declare({.name = "Record.fps",
                       .grammar = "<int 1..120>",
                       .initial = std::to_string(kFramesPerSecond),
                       .help = "Frames a second of films and of Frame reports.",
                       .on_set = core_.Command([this](const vm::SetValue& value) {
                         frames_per_second_ = static_cast<int>(value.number(0));
                       })});
  core_.slots.Declare({.name = "Record.start",
                       .grammar = "<text>",
                       .access = vm::Access::kReadOnly,
                       .help = "The instant of the film's first frame, in ms on this process's "
                               "clock; frame k shows the face k / Record.fps seconds later. Empty "
                               "while there is no film.",
                       .on_inq = [this]() -> std::string {
                         return film_.recording() ? vm::FormatMs(film_.start()) : "";
                       }});
  core_.slots.Declare(
      {.name = "Record",
       .grammar = "STOP | <file>",
       .initial = "STOP",
       .help = "Records a film from now on: .mp4; .mov or .webm, which keep what is transparent; "
               ".mkv, which loses nothing; or "
               ".rgba, width * height * 4 bytes a frame, into a file or a named pipe that is being "
               "read. STOP ends it, and answers when it is there.",
       .on_set = core_.Command([this](const vm::SetValue& value) { return Set(value.word(0)); }),
       .saved = false});
}

vm::Result<std::string> RecordSlots::Set(const std::string& file) {
  if (file == "STOP") return Stop();
  if (auto started = film_.Start(file, frames_per_second_); !started) {
    return std::unexpected(started.error());
  }
  return file;
}

vm::Result<std::string> RecordSlots::Stop() {
  const auto summary = film_.Stop(core_.slots.Value("Record.sound"));
  core_.slots.Store("Record", "STOP");
  if (!summary) return std::unexpected(summary.error());
  core_.log(fmt::format("{}: {} frames, {} of them repeated because drawing was late",
                        summary->path, summary->frames, summary->repeated));
  return "STOP";
}

void RecordSlots::StopActivity() {
  if (!film_.recording()) return;
  if (auto stopped = Stop(); !stopped) core_.slots.ReportError("Record", stopped.error());
}

}  // namespace fsm
