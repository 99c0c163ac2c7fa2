#include "hypermask/live/measurement.h"

#include <cmath>
#include <utility>

namespace hypermask {
namespace {

fsm::Image Plain(const Rig& rig, std::uint8_t value) {
  return fsm::FilledImage(rig.projector_width(), rig.projector_height(),
                          {value, value, value, 255});
}

double Mean(const Grey& picture) {
  double sum = 0;
  for (const std::uint8_t value : picture.pixels) sum += value;
  return sum / static_cast<double>(picture.pixels.size());
}

vm::Time Micros(double ms) { return vm::Time(std::llround(1000 * ms)); }

}  // namespace

void Measurement::MeasureDelay(const Rig& rig, DelayDone done) {
  delay_.emplace(
      DelayFlashes{.dark = Plain(rig, 0), .bright = Plain(rig, 255), .done = std::move(done)});
  end_timer_ = scheduler_.After(Micros(DelayMeter::kWholeMs + DelayMeter::kLongestMs), [this] {
    end_timer_ = 0;
    EndDelay(delay_->meter.Delay());
  });
  Flash();
}

void Measurement::TakePlace(const Rig& rig, const MaskLayout& layout, double delay_ms,
                            PlaceDone done) {
  constexpr double kSettleMs = 80;
  place_.emplace(rig, layout, delay_ms + kSettleMs, std::move(done));
  NextFrame();
}

void Measurement::Seen(const Grey& picture, vm::Time arrived) {
  if (delay_) {
    delay_->meter.Seen(vm::InMs(arrived), Mean(picture));
  } else if (place_->taker.Take(picture, vm::InMs(arrived))) {
    NextFrame();
  }
}

void Measurement::Cancel(const vm::Error& error) {
  if (delay_) EndDelay(std::unexpected(error));
  if (place_) EndPlace(std::unexpected(error));
}

void Measurement::Drop() {
  CancelTimers();
  delay_.reset();
  place_.reset();
}

void Measurement::Flash() {
  delay_->on = !delay_->on;
  delay_->meter.Shown(vm::InMs(scheduler_.Now()), delay_->on);
  show_(delay_->on ? delay_->bright : delay_->dark);
  if (!delay_) return;  // the projector is gone
  flash_timer_ = scheduler_.After(Micros(delay_->meter.NextHoldMs()), [this] {
    flash_timer_ = 0;
    Flash();
  });
}

void Measurement::NextFrame() {
  if (const auto frame = place_->taker.Begin(vm::InMs(scheduler_.Now()))) return show_(*frame);
  EndPlace(ReadPlace(place_->dots, place_->taker.pictures(), MarkerFinder(place_->layout)));
}

void Measurement::EndDelay(const vm::Result<double>& delay_ms) {
  CancelTimers();
  const DelayDone done = std::move(delay_->done);
  delay_.reset();
  done(delay_ms);
}

void Measurement::EndPlace(const vm::Result<Place>& place) {
  const PlaceDone done = std::move(place_->done);
  place_.reset();
  done(place);
}

void Measurement::CancelTimers() {
  for (vm::TimerId* const timer : {&flash_timer_, &end_timer_}) {
    if (*timer != 0) scheduler_.Cancel(std::exchange(*timer, 0));
  }
}

}  // namespace hypermask
