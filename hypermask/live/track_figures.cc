#include "hypermask/live/track_figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace hypermask {
namespace {

/// A mean that forgets: of the last twenty or so.
void Blend(double& mean, double value) {
  constexpr double kPart = 0.05;
  mean += (mean > 0 ? kPart : 1) * (value - mean);
}

}  // namespace

void TrackFigures::DeclareSlots() {
  slots_.DeclareTold("Track.speed", "0 0 0",
                     "Each second: pictures in it, in how many of them the mask was seen, and "
                     "how many ms after it was there what one shows was projected.");
  slots_.DeclareTold("Track.miss", "0",
                     "Each second on the simulated stage: how far the face lands from where "
                     "it should, pixels of the projector, root of mean square.");
}

void TrackFigures::Begin(vm::Time now) {
  picture_at_.reset();
  interval_ms_ = work_ms_ = 0;
  second_ = now;
  pictures_ = seen_ = missed_ = 0;
  miss_squares_ = 0;
}

void TrackFigures::Picture(vm::Time arrived) {
  ++pictures_;
  constexpr vm::Time kPause{200'000};  // a camera that stops for long says nothing of its rate
  if (picture_at_ && arrived > *picture_at_ && arrived - *picture_at_ < kPause) {
    Blend(interval_ms_, vm::InMs(arrived - *picture_at_));
  }
  picture_at_ = arrived;
}

void TrackFigures::Projected(double work_ms, std::optional<double> miss) {
  constexpr double kLeastMs = 1e-3;  // Blend takes 0 for "none yet"
  Blend(work_ms_, std::max(kLeastMs, work_ms));
  if (!miss) return;
  ++missed_;
  miss_squares_ += *miss * *miss;
}

void TrackFigures::Tell(vm::Time now) {
  if (now - second_ < vm::Time(1'000'000)) return;
  const double seconds = vm::InMs(now - second_) / 1000;
  slots_.Report("Track.speed",
                fmt::format("{:.1f} {} {:.1f}", pictures_ / seconds, seen_, work_ms_));
  if (missed_ > 0) {
    slots_.Report("Track.miss", fmt::format("{:.2f}", std::sqrt(miss_squares_ / missed_)));
  }
  second_ = now;
  pictures_ = seen_ = missed_ = 0;
  miss_squares_ = 0;
}

}  // namespace hypermask
