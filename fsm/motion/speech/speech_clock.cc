#include "fsm/motion/speech/speech_clock.h"

#include <algorithm>
#include <cmath>

#include "fsm/motion/base/easing.h"

namespace fsm {
namespace {

constexpr double kLateReportMs = 25;  // a report may be delayed this long by the drawing of a frame
constexpr int kLateReports = 3;

}  // namespace

double SpeechClock::CorrectionAt(vm::Time t) const {
  const double distance_ms = to_ms_ - from_ms_;
  const double done = std::min(std::abs(distance_ms), rate_ * std::max(0.0, InMs(t - since_)));
  return from_ms_ + std::copysign(done, distance_ms);
}

double SpeechClock::PositionAt(vm::Time t) const { return InMs(t - start_) + CorrectionAt(t); }

bool SpeechClock::IsJustLate(double difference_ms) {
  // Two consecutive reports may merely be late. From the third on the voice counts as behind, by
  // the least difference.
  const double behind = to_ms_ - difference_ms;
  late_ = behind > 0 && behind < kLateReportMs ? late_ + 1 : 0;
  return late_ > 0 && late_ < kLateReports;
}

void SpeechClock::Correct(vm::Time now, double voice_ms, double max_rate) {
  const double difference_ms = voice_ms - InMs(now - start_);
  const bool just_late = IsJustLate(difference_ms);
  nearest_ms_ = late_ <= 1 ? difference_ms : std::max(nearest_ms_, difference_ms);
  if (just_late) return;
  from_ms_ = CorrectionAt(now);
  to_ms_ = nearest_ms_;
  late_ = 0;
  since_ = now;
  rate_ = std::clamp(max_rate, 0.01, 0.9);
}

vm::Time SpeechClock::WhenAt(double position_ms) const {
  const double at_since = PositionAt(since_);
  if (position_ms <= at_since) return start_ + FromMs(position_ms - from_ms_);
  const double distance_ms = to_ms_ - from_ms_;
  const double speed = 1 + std::copysign(rate_, distance_ms);
  const double slewing_ms = std::abs(distance_ms) / rate_;
  const double within = (position_ms - at_since) / speed;
  if (within < slewing_ms) return since_ + FromMs(within);
  return start_ + FromMs(position_ms - to_ms_);
}

}  // namespace fsm
