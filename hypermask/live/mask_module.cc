#include "hypermask/live/mask_module.h"

#include <fmt/format.h>

#include <utility>

namespace hypermask {
MaskModule::MaskModule(vm::Scheduler& scheduler, Options options)
    : scheduler_(scheduler),
      options_(std::move(options)),
      slots_("MASK"),
      face_(slots_, options_.io, [this](const fsm::Image& picture) { SetFace(picture); }),
      measurement_(scheduler_, [this](const fsm::Image& frame) { Show(frame); }),
      figures_(slots_) {
  DeclareRun();
  face_.DeclareSlots();
  DeclareMask();
  DeclareSettings();
  DeclareCalibration();
  DeclareTold();
  figures_.DeclareSlots();
}

void MaskModule::Shutdown() {
  measurement_.Drop();
  if (retire_timer_ != 0) scheduler_.Cancel(std::exchange(retire_timer_, 0));
  ++run_;
  rig_.reset();
  retired_.clear();
  face_.Close();
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
  SetFace(face_.picture());
  misfit_told_ = no_mask_told_ = ever_seen_ = false;
  mask_at_ = scheduler_.Now();
  figures_.Begin(mask_at_);
  ResetFollower();
  Tell("LOOKING");
  return {};
}

void MaskModule::Stop() {
  if (!rig_) return;
  measurement_.Cancel({vm::Errc::kStopped, "Run was stopped or Input changed meanwhile"});
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
  follower_.emplace(layout_,
                    MaskFollower::Settings{
                        .prediction = prediction_, .ahead = AheadMs() / 1000, .spots = spots_});
}

void MaskModule::OnPicture(const Grey& picture, vm::Time arrived) {
  camera_width_ = picture.width;
  camera_height_ = picture.height;
  figures_.Picture(arrived);
  if (measurement_.Busy()) {
    measurement_.Seen(picture, arrived);
  } else {
    Follow(picture, arrived);
  }
  if (rig_) figures_.Tell(scheduler_.Now());
}

void MaskModule::Follow(const Grey& picture, vm::Time arrived) {
  const double seconds = vm::InMs(arrived) / 1000;
  const std::size_t seen = follower_->Look(picture, seconds);
  if (seen > 0) {
    figures_.Seen();
    mask_at_ = arrived;
    ever_seen_ = true;
    no_mask_told_ = false;
  } else {
    TellNoMask(arrived);
  }
  Tell(follower_->following() ? "FOLLOWING" : "LOOKING");
  if (slots_.AutoOutput("Track")) TellTrack(seen, arrived);
  std::optional<PlaneMap> map;
  if (CalibrationFits(picture)) {
    if (const auto markers = follower_->At(seconds + AheadMs() / 1000)) {
      map = MaskToProjector(*calibration_, form_, layout_, *markers);
    }
  }
  const auto miss = map ? rig_->Miss(*map, figures_.interval_ms() / 1000) : std::nullopt;
  Show(warp_->Draw(map ? &*map : nullptr));
  figures_.Projected(vm::InMs(scheduler_.Now() - arrived), miss);
}

void MaskModule::TellTrack(std::size_t seen, vm::Time arrived) {
  std::string places;
  for (const Point& marker : follower_->markers()) {
    places += fmt::format("{}[{:.2f},{:.2f}]", places.empty() ? "" : ",", marker.x(), marker.y());
  }
  slots_.Report("Track",
                fmt::format("{{\"ms\":{:.1f},\"seen\":{},\"markers\":[{}],\"ahead\":{:.1f}}}",
                            vm::InMs(arrived), seen, places, AheadMs()));
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

bool MaskModule::CanMeasure(const vm::Reply& reply) const {
  if (!rig_) {
    reply.Fail({vm::Errc::kUnavailable, "set Input and Run = START before"});
  } else if (Busy()) {
    reply.Fail({vm::Errc::kBusy, "something is being measured already"});
  } else {
    return true;
  }
  return false;
}

void MaskModule::BeginMeasurement(const std::string& stat) {
  rig_->TakeFilterOff(true);
  Tell(stat);
}

void MaskModule::EndMeasurement() {
  rig_->TakeFilterOff(false);
  mask_at_ = scheduler_.Now();  // nobody looked for it meanwhile
  Tell("LOOKING");
}

void MaskModule::MeasureDelay(const vm::Reply& reply) {
  if (!CanMeasure(reply)) return;
  BeginMeasurement("MEASURING");
  measurement_.MeasureDelay(*rig_, [this, reply](const vm::Result<double>& delay_ms) {
    EndMeasurement();
    if (!delay_ms) return reply.Fail(delay_ms.error());
    delay_ms_ = *delay_ms;
    if (calibration_) calibration_->delay_ms = delay_ms_;
    ResetFollower();
    const std::string text = fmt::format("{:g}", delay_ms_);
    slots_.Report("Delay", text);
    reply.Ok(text);
  });
}

void MaskModule::TakePlace(const vm::Reply& reply) {
  if (!CanMeasure(reply)) return;
  if (places_.size() == kMostPlaces) {
    return reply.Fail({vm::Errc::kLimit, fmt::format("there are {} places already", kMostPlaces)});
  }
  BeginMeasurement("CALIBRATING");
  measurement_.TakePlace(*rig_, layout_, delay_ms_, [this, reply](const vm::Result<Place>& place) {
    EndMeasurement();
    ResetFollower();
    if (!place) return reply.Fail(place.error());
    places_.push_back(*place);
    slots_.Report("Calibrate.places", std::to_string(places_.size()));
    reply.Ok("PLACE");
  });
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

void MaskModule::SetFace(const fsm::Image& picture) {
  if (warp_ && !picture.rgba.empty()) warp_->SetFace(picture);
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
