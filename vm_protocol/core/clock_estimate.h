#pragma once

#include <deque>

#include "vm_protocol/core/scheduler.h"

namespace vm {

/// Where another process's clock stands, from questions and answers over a link whose delay
/// changes. An answer was given somewhere between asking and hearing it, so half of that span is
/// what one exchange leaves open; and clocks drift apart, so old exchanges leave open more.
/// The exchange that leaves open least counts. Exchanges that cannot both be true mean that the
/// clock has jumped (its machine slept, say): then only those that agree with the newest count.
/// Pure.
class ClockEstimate {
 public:
  static constexpr std::size_t kMaxSamples = 32;
  /// Ordinary quartz clocks are within 50 ppm of true, so two of them within 100 ppm of each other.
  static constexpr double kDrift = 100e-6;

  /// It was asked at `asked` and heard at `heard`, both ours, that their clock stands at `theirs`.
  void Add(Time asked, Time heard, Time theirs);
  bool known() const { return !samples_.empty(); }
  Time offset() const { return best_.offset; }  ///< theirs minus ours
  Time delay() const { return best_.delay; }    ///< there and back, of the exchange that counts
  /// How far off the offset can be, at the time of the last exchange.
  Time uncertainty() const;

 private:
  struct Sample {
    Time heard{0}, offset{0}, delay{0};
  };
  Time Uncertainty(const Sample& sample) const;
  std::deque<Sample> samples_;
  Sample best_;
};

}  // namespace vm
