#pragma once

#include <optional>

#include "vm_protocol/core/scheduler.h"
#include "vm_protocol/core/slot_machine.h"

namespace hypermask {

/// Counts how well the mask is followed and tells it each second: the slots Track.speed and
/// Track.miss. Thread: the scheduler's. Lifetime: `slots` outlives it.
class TrackFigures {
 public:
  explicit TrackFigures(vm::SlotMachine& slots) : slots_(slots) {}
  void DeclareSlots();

  /// Forgets everything; the first second begins at `now`.
  void Begin(vm::Time now);
  /// The camera's picture was there at `arrived`.
  void Picture(vm::Time arrived);
  /// The mask was seen in it.
  void Seen() { ++seen_; }
  /// What it showed was projected `work_ms` after it was there, `miss` pixels of the projector off,
  /// where that is known.
  void Projected(double work_ms, std::optional<double> miss);
  /// Reports the second if it is over at `now`, and begins the next.
  void Tell(vm::Time now);

  /// ms between pictures and ms from having one to having projected, means of the last twenty or
  /// so; 0: none yet.
  double interval_ms() const { return interval_ms_; }
  double work_ms() const { return work_ms_; }

 private:
  vm::SlotMachine& slots_;
  std::optional<vm::Time> picture_at_;
  double interval_ms_ = 0, work_ms_ = 0;
  // Of the second that is being counted.
  vm::Time second_{0};
  int pictures_ = 0, seen_ = 0, missed_ = 0;
  double miss_squares_ = 0;
};

}  // namespace hypermask
