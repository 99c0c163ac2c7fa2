#include "fsm/app/capture_slots.h"

#include <algorithm>
#include <filesystem>

namespace fsm {

CaptureSlots::CaptureSlots(FsmCore& core)
    : core_(core),
      capture_(
          core.clock, core.view, core.files,
          [this](long number, vm::Time at) { return core_.DrawFrame(number, at); },
          [this](const vm::Result<void>& done) {
            core_.slots.Report("Capture", "DISABLE");
            if (!done) core_.slots.ReportError("Capture", done.error());
          }) {
  core_.slots.Declare(
      {.name = "Capture",
       .grammar = "STOP | <word> <word> <number 0.1..120> [ BMP | PNG ]",
       .initial = "DISABLE",
       .help =
           "Numbered pictures of the next utterance, from Speak = NOW to its end: folder, "
           "prefix, pictures a second. Its value is ENABLE until they are made, else DISABLE. At "
           "most 36000 of them and 8 GiB.",
       .on_set = [this](const vm::SetValue& value) { return Set(value); },
       .saved = false});
}

void CaptureSlots::OnSpeechEnd() {
  // On a busy machine the end is detected late.
  const vm::Time now = core_.Now();
  capture_.End(std::min(now, core_.motion->speech.End().value_or(now)));
}

vm::Result<std::string> CaptureSlots::Set(const vm::SetValue& value) {
  if (value.word(0) == "STOP" && value.size() == 1) {
    capture_.Cancel();
    return "DISABLE";
  }
  if (capture_.running()) {
    return vm::Fail(vm::Errc::kBusy, "pictures are being captured; wait for IDLE");
  }
  std::error_code code;
  std::filesystem::create_directories(value.word(0), code);
  if (!std::filesystem::is_directory(value.word(0), code)) {
    return vm::Fail(vm::Errc::kUnavailable,
                    "'" + value.word(0) + "' is not a folder and cannot be made one");
  }
  const bool png = value.size() > 3 && value.word(3) == "PNG";
  capture_.Arm({value.word(0), value.word(1), value.number(2), png ? ".png" : ".bmp"});
  return "ENABLE";
}

}  // namespace fsm
