#include "hypermask/live/mask_module.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace hypermask {
namespace {

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
