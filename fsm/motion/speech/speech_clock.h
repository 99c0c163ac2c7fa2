#pragma once

#include "vm_protocol/core/scheduler.h"

namespace fsm {

/// Estimates the position of the voice in the utterance: the time since the start, corrected by
/// reports of the samples actually played. Corrections are applied at a limited rate, so the mouth
/// never jumps and never goes back. On a busy machine reports arrive late, never early: one that is
/// slightly behind counts only if the next two agree.
class SpeechClock {
 public:
  explicit SpeechClock(vm::Time start) : start_(start), since_(start) {}

  /// Returns the position in milliseconds; negative before the start.
  double PositionAt(vm::Time t) const;
  /// Takes a report that the voice is at `voice_ms` now. `max_rate`, 0.01..0.9, limits the
  /// correction in ms per ms.
  void Correct(vm::Time now, double voice_ms, double max_rate);
  /// Returns when a position will be reached if there are no more reports.
  vm::Time WhenAt(double position_ms) const;

 private:
  double CorrectionAt(vm::Time t) const;
  /// Counts consecutive reports that are slightly behind. Returns true while these may merely have
  /// arrived late.
  bool IsJustLate(double difference_ms);

  vm::Time start_;
  vm::Time since_;      // when the current correction began
  double from_ms_ = 0;  // the correction at `since_`
  double to_ms_ = 0;    // and its target
  double rate_ = 0.25;
  int late_ = 0;           // consecutive reports that were slightly behind
  double nearest_ms_ = 0;  // the least delayed of them
};

}  // namespace fsm
