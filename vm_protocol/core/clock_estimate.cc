#include "vm_protocol/core/clock_estimate.h"

namespace vm {

Time ClockEstimate::Uncertainty(const Sample& sample) const {
  const auto age = static_cast<double>((samples_.back().heard - sample.heard).count());
  return sample.delay / 2 + Time(static_cast<Time::rep>(age * kDrift));
}

Time ClockEstimate::uncertainty() const { return known() ? Uncertainty(best_) : Time(0); }

void ClockEstimate::Add(Time asked, Time heard, Time theirs) {
  const Time delay = heard - asked;
  const Sample newest{heard, theirs - (asked + delay / 2), delay};
  std::erase_if(samples_, [&](const Sample& old) {
    const auto age = static_cast<double>((heard - old.heard).count());
    const Time allowed = delay / 2 + old.delay / 2 + Time(2 + static_cast<Time::rep>(age * kDrift));
    return std::chrono::abs(newest.offset - old.offset) > allowed;
  });
  samples_.push_back(newest);
  if (samples_.size() > kMaxSamples) samples_.pop_front();
  best_ = samples_.back();
  for (const Sample& sample : samples_) {
    if (Uncertainty(sample) < Uncertainty(best_)) best_ = sample;
  }
}

}  // namespace vm
