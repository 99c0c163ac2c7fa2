#include "hypermask/live/mask_module.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "fsm/image/image_file.h"

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

fsm::Image Plain(const Rig& rig, std::uint8_t value) {
  return fsm::FilledImage(rig.projector_width(), rig.projector_height(),
                          {value, value, value, 255});
}

double Mean(const Grey& picture) {
  double sum = 0;
  for (const std::uint8_t value : picture.pixels) sum += value;
  return sum / static_cast<double>(picture.pixels.size());
}

/// A mean that forgets: of the last twenty or so.
void Blend(double& mean, double value) {
  constexpr double kPart = 0.05;
  mean += (mean > 0 ? kPart : 1) * (value - mean);
}

vm::Time Micros(double ms) { return vm::Time(std::llround(1000 * ms)); }

bool IsPicture(const std::string& name) {
  constexpr std::string_view kEnds[] = {".png", ".jpg", ".jpeg", ".bmp", ".rgb"};
  return std::ranges::any_of(kEnds, [&](std::string_view end) { return name.ends_with(end); });
}

}  // namespace

MaskModule::MaskModule(vm::Scheduler& scheduler, Options options)
    : scheduler_(scheduler), options_(std::move(options)), slots_("MASK") {
  DeclareRun();
  DeclareFace();
  DeclareSettings();
  DeclareCalibration();
  DeclareTold();
}

void MaskModule::CancelTimers() {
  for (vm::TimerId* const timer : {&timer_, &end_timer_}) {
    if (*timer != 0) scheduler_.Cancel(std::exchange(*timer, 0));
  }
}

void MaskModule::Shutdown() {
  CancelTimers();
  meter_.reset();
  taker_.reset();
  if (retire_timer_ != 0) scheduler_.Cancel(std::exchange(retire_timer_, 0));
  ++run_;
  rig_.reset();
  retired_.clear();
  face_stream_.reset();
  face_film_.reset();
}

void MaskModule::DeclareRun() {
  slots_.Declare({.name = "Run",
                  .grammar = "START | STOP | LIVE | EXIT",
                  .initial = "LIVE",
                  .auto_output = true,
                  .help = "START: the mask in Input is followed and the face projected onto it "
                          "from now on. STOP: no longer. EXIT ends the module.",
                  .on_set_later =
                      [this](const vm::SetValue& value, const vm::Reply& reply) {
                        const std::string& word = value.word(0);
                        if (word == "START") {
                          on_ = true;
                          if (auto started = Start(); !started) {
                            on_ = false;
                            return reply.Fail(started.error());
                          }
                        }
                        slots_.Report("Run", word);
                        if (word == "STOP" || word == "EXIT") {
                          on_ = false;
                          Stop();
                        }
                        reply.Ok(word);
                        if (word == "EXIT") exit_requested_ = true;
                      },
                  .saved = false});
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

void MaskModule::DeclareFace() {
  slots_.Declare({.name = "Face",
                  .grammar = "NONE | <file>",
                  .initial = "NONE",
                  .help = "The face that is projected: a picture (.png, .jpg, .bmp, .rgb), or a "
                          "film, once.",
                  .on_set = [this](const vm::SetValue& value) -> vm::Result<std::string> {
                    if (auto opened = OpenFace(value.text); !opened) {
                      return std::unexpected(opened.error());
                    }
                    return value.text;
                  }});
  slots_.Declare({.name = "Face.from",
                  .grammar = "NONE | <word>",
                  .initial = "NONE",
                  .help =
                      "The module whose pictures are projected, as FSM: it is asked for them by "
                      "its slot Picture.to.",
                  .on_set = [this](const vm::SetValue& value) -> vm::Result<std::string> {
                    if (auto asked = AskFace(value.word(0)); !asked) {
                      return std::unexpected(asked.error());
                    }
                    return face_from_;
                  },
                  .saved = false});
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
  slots_.Declare({.name = "Calibrate.rms",
                  .grammar = "<text>",
                  .access = vm::Access::kReadOnly,
                  .auto_output = true,
                  .help = "How far homography, affine map and space are from the dots of all "
                          "places: pixels of the projector, root of mean square."});
}

void MaskModule::DeclareTold() {
  const auto declare = [this](std::string name, std::string initial, std::string help,
                              bool auto_output) {
    slots_.Declare({.name = std::move(name),
                    .grammar = "<text>",
                    .access = vm::Access::kReadOnly,
                    .initial = std::move(initial),
                    .auto_output = auto_output,
                    .help = std::move(help)});
  };
  declare("ModuleVersion", options_.module_version, "The version of this program.", false);
  declare("ProtocolVersion", "Galatea protocol 1.0", "The version of the protocol it speaks.",
          false);
  declare("Track", "",
          "Each picture as a JSON object: ms, how many markers were seen, where they are "
          "(pixels of the camera), how many ms ahead the face is placed.",
          false);
  declare("Track.stat", "OFF", "OFF, LOOKING (for the mask), FOLLOWING, MEASURING or CALIBRATING.",
          true);
  declare("Track.speed", "0 0 0",
          "Each second: pictures in it, in how many of them the mask was seen, and how many ms "
          "after it was there what one shows was projected.",
          false);
  declare("Track.miss", "0",
          "Each second on the simulated stage: how far the face lands from where it should, pixels "
          "of the projector, root of mean square.",
          false);
}

vm::Result<void> MaskModule::Start() {
  if (!on_ || rig_ || input_ == "NONE") return {};
  const unsigned run = ++run_;
  auto rig = options_.open({.input = input_, .screen = screen_, .layout = layout_},
                           {.picture =
                                [this, run](const Grey& picture, vm::Time arrived) {
                                  if (run == run_ && rig_) OnPicture(picture, arrived);
                                },
                            .over =
                                [this, run](const std::optional<vm::Error>& error) {
                                  if (run == run_ && rig_) Over(error);
                                }});
  if (!rig) return std::unexpected(rig.error());
  rig_ = std::move(*rig);
  warp_.emplace(layout_, rig_->projector_width(), rig_->projector_height());
  if (!face_.rgba.empty()) warp_->SetFace(face_);
  ResetFollower();
  misfit_told_ = no_mask_told_ = ever_seen_ = false;
  interval_ms_ = work_ms_ = 0;
  second_ = mask_at_ = scheduler_.Now();
  picture_at_.reset();
  pictures_ = seen_ = missed_ = 0;
  miss_squares_ = 0;
  Tell("LOOKING");
  return {};
}

void MaskModule::Stop() {
  if (!rig_) return;
  const vm::Error stopped{vm::Errc::kStopped, "Run was stopped or Input changed meanwhile"};
  if (meter_) EndDelay(std::unexpected(stopped));
  if (taker_) EndPlace(std::unexpected(stopped));
  ++run_;
  // One of its events may be going on.
  retired_.push_back(std::move(rig_));
  if (retire_timer_ == 0) {
    retire_timer_ = scheduler_.Post([this] {
      retire_timer_ = 0;
      retired_.clear();
    });
  }
  follower_.reset();
  warp_.reset();
  Tell("OFF");
}

void MaskModule::Over(const std::optional<vm::Error>& error) {
  if (error) {
    slots_.ReportError("Input", *error);
  } else if (!ever_seen_) {
    TellNoMask(mask_at_ + kNoMask);
  }
  Stop();
  input_ = "NONE";
  slots_.Report("Input", input_);
}

void MaskModule::ResetFollower() {
  if (!rig_) return;
  // What is shown between two pictures is to be right in the middle of that time.
  const double ahead_ms = delay_ms_ + work_ms_ + interval_ms_ / 2;
  follower_.emplace(
      layout_,
      MaskFollower::Settings{.prediction = prediction_, .ahead = ahead_ms / 1000, .spots = spots_});
}

void MaskModule::OnPicture(const Grey& picture, vm::Time arrived) {
  ++pictures_;
  camera_width_ = picture.width;
  camera_height_ = picture.height;
  constexpr vm::Time kPause{200'000};  // a camera that stops for long says nothing of its rate
  if (picture_at_ && arrived > *picture_at_ && arrived - *picture_at_ < kPause) {
    Blend(interval_ms_, Ms(arrived - *picture_at_));
  }
  picture_at_ = arrived;
  if (meter_) {
    meter_->Seen(Ms(arrived), Mean(picture));
  } else if (taker_) {
    if (taker_->Take(picture, Ms(arrived))) NextFrame();
  } else {
    Follow(picture, arrived);
  }
  if (rig_) TellSecond(scheduler_.Now());
}

void MaskModule::Follow(const Grey& picture, vm::Time arrived) {
  const double seconds = Ms(arrived) / 1000;
  const std::size_t seen = follower_->Look(picture, seconds);
  const double ahead_ms = delay_ms_ + work_ms_ + interval_ms_ / 2;
  if (seen > 0) {
    ++seen_;
    mask_at_ = arrived;
    ever_seen_ = true;
    no_mask_told_ = false;
  } else {
    TellNoMask(arrived);
  }
  Tell(follower_->following() ? "FOLLOWING" : "LOOKING");
  if (slots_.AutoOutput("Track")) TellTrack(seen, arrived, ahead_ms);
  std::optional<PlaneMap> map;
  if (CalibrationFits(picture)) {
    if (const auto markers = follower_->At(seconds + ahead_ms / 1000)) {
      map = MaskToProjector(*calibration_, form_, layout_, *markers);
    }
  }
  const auto miss = map ? rig_->Miss(*map, interval_ms_ / 1000) : std::nullopt;
  if (miss) {
    ++missed_;
    miss_squares_ += *miss * *miss;
  }
  Show(warp_->Draw(map ? &*map : nullptr));
  Blend(work_ms_, std::max(1e-3, Ms(scheduler_.Now() - arrived)));
}

void MaskModule::TellTrack(std::size_t seen, vm::Time arrived, double ahead_ms) {
  std::string places;
  for (const Point& marker : follower_->markers()) {
    places += fmt::format("{}[{:.2f},{:.2f}]", places.empty() ? "" : ",", marker.x(), marker.y());
  }
  slots_.Report("Track",
                fmt::format("{{\"ms\":{:.1f},\"seen\":{},\"markers\":[{}],\"ahead\":{:.1f}}}",
                            Ms(arrived), seen, places, ahead_ms));
}

void MaskModule::TellSecond(vm::Time now) {
  if (now - second_ < vm::Time(1'000'000)) return;
  const double seconds = Ms(now - second_) / 1000;
  slots_.Report("Track.speed",
                fmt::format("{:.1f} {} {:.1f}", pictures_ / seconds, seen_, work_ms_));
  if (missed_ > 0) {
    slots_.Report("Track.miss", fmt::format("{:.2f}", std::sqrt(miss_squares_ / missed_)));
  }
  second_ = now;
  pictures_ = seen_ = missed_ = 0;
  miss_squares_ = 0;
}

void MaskModule::TellNoMask(vm::Time now) {
  if (no_mask_told_ || now - mask_at_ < kNoMask) return;
  no_mask_told_ = true;
  slots_.ReportError(
      "Input", {vm::Errc::kUnavailable,
                fmt::format("no mask is seen in '{}': there are {} bright spots, its {} markers "
                            "are looked for",
                            input_, follower_ ? follower_->spots() : 0, layout_.markers.size())});
}

bool MaskModule::CalibrationFits(const Grey& picture) {
  std::string problem;
  if (!calibration_) {
    problem = "nothing is projected before there is a calibration";
  } else if (calibration_->camera.width != picture.width ||
             calibration_->camera.height != picture.height ||
             calibration_->projector_width != rig_->projector_width() ||
             calibration_->projector_height != rig_->projector_height()) {
    problem = fmt::format(
        "it was made for a camera of {} x {} and a projector of {} x {}, here they have {} x {} "
        "and {} x {}",
        calibration_->camera.width, calibration_->camera.height, calibration_->projector_width,
        calibration_->projector_height, picture.width, picture.height, rig_->projector_width(),
        rig_->projector_height());
  }
  if (problem.empty()) return true;
  if (!std::exchange(misfit_told_, true)) {
    slots_.ReportError("Calibration", {vm::Errc::kUnavailable, problem});
  }
  return false;
}

void MaskModule::MeasureDelay(const vm::Reply& reply) {
  if (!rig_) {
    return reply.Fail({vm::Errc::kUnavailable, "set Input and Run = START before"});
  }
  if (Busy()) return reply.Fail({vm::Errc::kBusy, "something is being measured already"});
  meter_.emplace();
  reply_ = reply;
  rig_->TakeFilterOff(true);
  Tell("MEASURING");
  flash_on_ = true;  // the first is dark
  end_timer_ = scheduler_.After(Micros(DelayMeter::kWholeMs + DelayMeter::kLongestMs), [this] {
    end_timer_ = 0;
    EndDelay(meter_->Delay());
  });
  Flash();
}

void MaskModule::Flash() {
  flash_on_ = !flash_on_;
  meter_->Shown(Ms(scheduler_.Now()), flash_on_);
  Show(Plain(*rig_, flash_on_ ? 255 : 0));
  if (!meter_) return;  // the projector is gone
  timer_ = scheduler_.After(Micros(meter_->NextHoldMs()), [this] {
    timer_ = 0;
    Flash();
  });
}

void MaskModule::EndDelay(const vm::Result<double>& delay) {
  CancelTimers();
  meter_.reset();
  rig_->TakeFilterOff(false);
  mask_at_ = scheduler_.Now();  // nobody looked for it meanwhile
  Tell("LOOKING");
  const vm::Reply reply = *std::exchange(reply_, std::nullopt);
  if (!delay) return reply.Fail(delay.error());
  delay_ms_ = *delay;
  if (calibration_) calibration_->delay_ms = delay_ms_;
  ResetFollower();
  const std::string text = fmt::format("{:g}", delay_ms_);
  slots_.Report("Delay", text);
  reply.Ok(text);
}

void MaskModule::TakePlace(const vm::Reply& reply) {
  if (!rig_) {
    return reply.Fail({vm::Errc::kUnavailable, "set Input and Run = START before"});
  }
  if (Busy()) return reply.Fail({vm::Errc::kBusy, "something is being measured already"});
  if (places_.size() == kMostPlaces) {
    return reply.Fail({vm::Errc::kLimit, fmt::format("there are {} places already", kMostPlaces)});
  }
  constexpr double kSettle = 80;
  pattern_.emplace(rig_->projector_width(), rig_->projector_height());
  taker_.emplace(*pattern_, delay_ms_ + kSettle);
  reply_ = reply;
  rig_->TakeFilterOff(true);
  Tell("CALIBRATING");
  NextFrame();
}

void MaskModule::NextFrame() {
  if (const auto frame = taker_->Begin(Ms(scheduler_.Now()))) return Show(*frame);
  EndPlace(ReadPlace(*pattern_, taker_->pictures(), MarkerFinder(layout_)));
}

void MaskModule::EndPlace(const vm::Result<Place>& place) {
  taker_.reset();
  pattern_.reset();
  rig_->TakeFilterOff(false);
  mask_at_ = scheduler_.Now();  // nobody looked for it meanwhile
  Tell("LOOKING");
  ResetFollower();
  const vm::Reply reply = *std::exchange(reply_, std::nullopt);
  if (!place) return reply.Fail(place.error());
  places_.push_back(*place);
  slots_.Report("Calibrate.places", std::to_string(places_.size()));
  reply.Ok("PLACE");
}

vm::Result<void> MaskModule::FinishCalibration(const std::string& file) {
  if (!rig_ || camera_width_ == 0) {
    return vm::Fail(vm::Errc::kUnavailable, "set Input and Run = START before");
  }
  auto made =
      Calibrate(places_, layout_, Pinhole::OfField(camera_width_, camera_height_, field_degrees_),
                rig_->projector_width(), rig_->projector_height());
  if (!made) return std::unexpected(made.error());
  made->delay_ms = delay_ms_;
  if (auto written = WriteCalibration(*made, file); !written) return written;
  slots_.Report("Calibrate.rms", fmt::format("{:.2f} {:.2f} {:.2f}", made->homography_rms,
                                             made->affine_rms, made->space_rms));
  calibration_ = std::move(*made);
  misfit_told_ = false;
  slots_.Report("Calibration", file);
  return {};
}

vm::Result<void> MaskModule::OpenFace(const std::string& name) {
  if (name == "NONE" || IsPicture(name)) {
    fsm::Image picture;
    if (name != "NONE") {
      auto read = fsm::ReadImage(name);
      if (!read) return std::unexpected(read.error());
      picture = std::move(*read);
    }
    face_film_.reset();
    face_ = std::move(picture);
    if (warp_ && !face_.rgba.empty()) warp_->SetFace(face_);
    return {};
  }
  if (!options_.io) return vm::Fail(vm::Errc::kUnavailable, "there are no films here");
  constexpr double kFolderRate = 25;
  auto source = facetrack::OpenPictures(name, kFolderRate);
  if (!source) return std::unexpected(source.error());
  face_film_ = std::make_unique<LivePictures>(
      *options_.io, std::move(*source), facetrack::IsLive(name),
      LivePictures::Events{.picture =
                               [this](const fsm::Image& picture, LivePictures::Clock::time_point) {
                                 face_ = picture;
                                 if (warp_) warp_->SetFace(face_);
                               },
                           .over =
                               [this](const std::optional<vm::Error>& error) {
                                 if (error) slots_.ReportError("Face", *error);
                               }});
  return {};
}

vm::Result<void> MaskModule::AskFace(const std::string& module) {
  const auto ask = [this](const std::string& to) {
    slots_.Say(vm::To(face_from_, vm::Set("Picture.to", to)));
  };
  if (module != "NONE" && !vm::IsModuleName(module)) {
    return vm::Fail(vm::Errc::kBadValue, "'" + module + "' is not a module's name");
  }
  if (face_from_ != "NONE") ask("NONE");
  face_stream_.reset();
  face_from_ = "NONE";
  if (module == "NONE") return {};
  if (!options_.io) return vm::Fail(vm::Errc::kUnavailable, "there are no sockets here");
  auto stream = FaceStream::Listen(
      *options_.io,
      {.picture =
           [this](const fsm::Image& picture) {
             face_ = picture;
             if (warp_) warp_->SetFace(face_);
           },
       .gone = [this](const vm::Error& error) { slots_.ReportError("Face.from", error); }});
  if (!stream) return std::unexpected(stream.error());
  face_stream_ = std::move(*stream);
  face_from_ = module;
  ask(face_stream_->place());
  return {};
}

void MaskModule::Show(const fsm::Image& frame) {
  if (const auto shown = rig_->Show(frame); !shown) {
    slots_.ReportError("Projector", shown.error());
    Stop();
    on_ = false;
    slots_.Report("Run", "STOP");
  }
}

void MaskModule::Tell(const std::string& stat) {
  if (stat == std::exchange(stat_, stat)) return;
  slots_.Report("Track.stat", stat);
}

}  // namespace hypermask
