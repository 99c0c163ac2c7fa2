// The slots of the module that projects the face onto a mask.

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "hypermask/live/mask_module.h"

namespace hypermask {
namespace {

constexpr std::pair<const char*, Prediction> kPredictions[] = {
    {"OFF", Prediction::kOff}, {"SINGLE", Prediction::kSingle}, {"BANK", Prediction::kBank}};
constexpr std::pair<const char*, Form> kForms[] = {
    {"HOMOGRAPHY", Form::kHomography}, {"AFFINE", Form::kAffine}, {"SPACE", Form::kSpace}};

template <typename Table>
auto ValueOf(const Table& table, const std::string& word) {
  return std::ranges::find(table, word, [](const auto& row) { return std::string(row.first); })
      ->second;
}

}  // namespace

void MaskModule::DeclareRun() {
  vm::DeclareCommonSlots(slots_,
                         {.module_version = options_.module_version,
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
                          .work = "the mask in Input is followed and the face projected onto it",
                          .on_exit =
                              [this] {
                                on_ = false;
                                Stop();
                                exit_requested_ = true;
                              }});
  slots_.Declare({.name = "Input",
                  .grammar = "NONE | <file>",
                  .initial = "NONE",
                  .auto_output = true,
                  .help =
                      "The camera that sees the mask: NONE, camera (/dev/video0), v4l2:DEVICE, "
                      "ffmpeg:WORDS (any input of ffmpeg), a film or a folder of pictures, or the "
                      "simulated stage, sim:MOVEMENT with delay=MS seed=N rate=HZ cover=S "
                      "(docs/hypermask.md). It is looked at while Run is START.",
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
  slots_.Declare({.name = "Projector",
                  .grammar = "NONE | WINDOW | SCREEN <int 1..9>",
                  .initial = "NONE",
                  .help = "Where the face is projected: NONE, nowhere; WINDOW, a window of 1280 x "
                          "720; SCREEN N, the whole of the Nth screen. The simulated stage has its "
                          "own.",
                  .on_set = [this](const vm::SetValue& value) -> vm::Result<std::string> {
                    const std::string& word = value.word(0);
                    Stop();
                    screen_ = word == "NONE" ? -1 : 0;
                    if (word == "SCREEN") screen_ = static_cast<int>(value.number(1));
                    if (auto started = Start(); !started) {
                      screen_ = -1;
                      slots_.Store("Projector", "NONE");
                      return std::unexpected(started.error());
                    }
                    return value.text;
                  }});
}

void MaskModule::DeclareMask() {
  slots_.Declare({.name = "Mask",
                  .grammar = "DEFAULT | <file>",
                  .initial = "DEFAULT",
                  .help = "Where the mask's markers are and what of it the face covers: a file "
                          "(docs/hypermask.md), for the next START.",
                  .on_set = [this](const vm::SetValue& value) -> vm::Result<std::string> {
                    auto layout = value.text == "DEFAULT" ? MaskLayout::Default()
                                                          : ReadMaskLayout(value.text);
                    if (!layout) return std::unexpected(layout.error());
                    layout_ = std::move(*layout);
                    return value.text;
                  }});
}

void MaskModule::DeclareSettings() {
  slots_.Declare({.name = "Predict",
                  .grammar = "OFF | SINGLE | BANK",
                  .initial = "BANK",
                  .help = "How the delay is made up for. SINGLE: one Kalman filter of constant "
                          "velocity. BANK: several filters, weighted by how well each has foretold "
                          "lately.",
                  .on_set = [this](const vm::SetValue& value) -> vm::Result<std::string> {
                    prediction_ = ValueOf(kPredictions, value.word(0));
                    ResetFollower();
                    return value.word(0);
                  }});
  slots_.Declare({.name = "Form",
                  .grammar = "HOMOGRAPHY | AFFINE | SPACE",
                  .initial = "SPACE",
                  .help = "How the camera's picture is brought to the projector's: by one "
                          "homography, one affine map, or by where the mask stands in space.",
                  .on_set = [this](const vm::SetValue& value) -> vm::Result<std::string> {
                    form_ = ValueOf(kForms, value.word(0));
                    return value.word(0);
                  }});
  slots_.Declare(
      {.name = "Delay",
       .grammar = "MEASURE | <number 0..1000>",
       .initial = "100",
       .auto_output = true,
       .help = "ms from the camera to the projector's light that are made up for, but for the "
               "program's own work, which it knows. MEASURE: by flashes, which takes 7 s; the "
               "answer is what was measured.",
       .on_set_later =
           [this](const vm::SetValue& value, const vm::Reply& reply) {
             if (value.word(0) == "MEASURE") return MeasureDelay(reply);
             delay_ms_ = value.number(0);
             ResetFollower();
             slots_.Report("Delay", value.word(0));
             reply.Ok(value.word(0));
           },
       .on_inq = [this] { return fmt::format("{:g}", delay_ms_); }});
  slots_.Declare({.name = "Field",
                  .grammar = "<number 5..120>",
                  .initial = fmt::format("{:g}", field_degrees_),
                  .help = "Degrees the camera sees from below to above, for the next calibration.",
                  .on_set = [this](const vm::SetValue& value) -> vm::Result<std::string> {
                    field_degrees_ = value.number(0);
                    return value.word(0);
                  }});
  slots_.Declare({.name = "Threshold",
                  .grammar = "<number 0.1..0.95>",
                  .initial = fmt::format("{:g}", spots_.threshold),
                  .help =
                      "From where on a pixel belongs to a marker: 0 = the picture's median, 1 = "
                      "its brightest pixel.",
                  .on_set = [this](const vm::SetValue& value) -> vm::Result<std::string> {
                    spots_.threshold = value.number(0);
                    ResetFollower();
                    return value.word(0);
                  }});
}

void MaskModule::DeclareCalibration() {
  slots_.Declare({.name = "Calibration",
                  .grammar = "NONE | <file>",
                  .initial = "NONE",
                  .auto_output = true,
                  .help = "What camera and projector are to each other: a file that Calibrate has "
                          "made. Its delay becomes Delay.",
                  .on_set = [this](const vm::SetValue& value) -> vm::Result<std::string> {
                    misfit_told_ = false;
                    if (value.text == "NONE") {
                      calibration_.reset();
                      return value.text;
                    }
                    auto read = ReadCalibration(value.text);
                    if (!read) return std::unexpected(read.error());
                    calibration_ = *read;
                    if (read->delay_ms) {
                      delay_ms_ = *read->delay_ms;
                      slots_.Report("Delay", fmt::format("{:g}", delay_ms_));
                      ResetFollower();
                    }
                    return value.text;
                  }});
  slots_.Declare(
      {.name = "Calibrate",
       .grammar = "PLACE | CLEAR | DONE <file>",
       .access = vm::Access::kWriteOnly,
       .help = "PLACE: a pattern is projected while the mask is held still, some seconds. DONE: "
               "the calibration of all places, three or more, is written and used. CLEAR: forgets "
               "them.",
       .on_set_later = [this](const vm::SetValue& value, const vm::Reply& reply) {
         const std::string& word = value.word(0);
         if (word == "PLACE") return TakePlace(reply);
         if (word == "CLEAR") {
           places_.clear();
           slots_.Report("Calibrate.places", "0");
           return reply.Ok(word);
         }
         if (auto done = FinishCalibration(value.word(1)); !done) {
           return reply.Fail(done.error());
         }
         reply.Ok(value.text);
       }});
  slots_.Declare({.name = "Calibrate.places",
                  .grammar = "<int>",
                  .access = vm::Access::kReadOnly,
                  .initial = "0",
                  .auto_output = true,
                  .help = "In how many places the mask was held still."});
  slots_.DeclareTold("Calibrate.rms", "",
                     "How far homography, affine map and space are from the dots of all "
                     "places: pixels of the projector, root of mean square.",
                     true);
}

void MaskModule::DeclareTold() {
  slots_.DeclareTold(
      "Track", "",
      "Each picture as a JSON object: ms, how many markers were seen, where they are "
      "(pixels of the camera), how many ms ahead the face is placed.");
  slots_.DeclareTold("Track.stat", "OFF",
                     "OFF, LOOKING (for the mask), FOLLOWING, MEASURING or CALIBRATING.", true);
}

}  // namespace hypermask
