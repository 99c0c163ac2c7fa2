// How the module measures the delay and takes places for a calibration.

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "hypermask/live/mask_module.h"

namespace hypermask {
namespace {

fsm::Image Plain(const Rig& rig, std::uint8_t value) {
  return fsm::FilledImage(rig.projector_width(), rig.projector_height(),
                          {value, value, value, 255});
}

vm::Time Micros(double ms) { return vm::Time(std::llround(1000 * ms)); }

}  // namespace

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

}  // namespace hypermask
