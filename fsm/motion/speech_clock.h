#pragma once

#include "vm_protocol/core/scheduler.h"

namespace fsm {

/// Where the voice is in the utterance, as the face believes it: one millisecond a millisecond
/// since the start, corrected by what the voice reports of the samples really played. A correction
/// is worked off at a limited rate, so the mouth never jumps and never goes back. Reports come late
/// on a busy machine, never early: one that seems a little behind counts when the next two agree.
class SpeechClock {
 public:
  explicit SpeechClock(vm::Time start) : start_(start), since_(start) {}

  /// Milliseconds into the utterance; negative before the start.
  double PositionAt(vm::Time t) const;
  /// The voice says it is at `voice_ms` now. `max_rate` is how much faster or slower than time the
  /// position may run meanwhile, 0.01 .. 0.9.
  void Correct(vm::Time now, double voice_ms, double max_rate);
  /// When the position is reached, if nothing more is reported.
  vm::Time WhenAt(double position_ms) const;

 private:
  double CorrectionAt(vm::Time t) const;
  /// Counts reports in a row that are a little behind; true while they may only have come late.
  bool IsJustLate(double difference_ms);

  vm::Time start_;
  vm::Time since_;      // when the present correction began
  double from_ms_ = 0;  // the correction then
  double to_ms_ = 0;    // and where it is going
  double rate_ = 0.25;
  int late_ = 0;           // reports in a row that were a little behind
  double nearest_ms_ = 0;  // the least delayed of them
};

}  // namespace fsm
