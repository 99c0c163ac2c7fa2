#pragma once

#include <functional>
#include <optional>

#include "hypermask/calibrate/calibrator.h"
#include "hypermask/calibrate/delay_meter.h"
#include "hypermask/live/rig.h"

namespace hypermask {

/// Measures something that takes camera and projector for itself, one thing at a time: the delay by
/// flashes, or a place of the mask by a pattern. Thread: the scheduler's. Each `done` is called
/// once, at the end or by Cancel, and may begin another measurement; Drop forgets it.
class Measurement {
 public:
  using DelayDone = std::function<void(const vm::Result<double>& delay_ms)>;
  using PlaceDone = std::function<void(const vm::Result<Place>& place)>;

  /// `show` projects a frame; it may call Cancel, if the projector is gone.
  Measurement(vm::Scheduler& scheduler, std::function<void(const fsm::Image& frame)> show)
      : scheduler_(scheduler), show_(std::move(show)) {}
  ~Measurement() { Drop(); }
  Measurement(const Measurement&) = delete;

  /// REQUIRES: not Busy(). Errors of `done`: as DelayMeter::Delay, and that of Cancel.
  void MeasureDelay(const Rig& rig, DelayDone done);
  /// `delay_ms`: from the camera to the projector's light, as known so far.
  /// REQUIRES: not Busy(). Errors of `done`: as ReadPlace, and that of Cancel.
  void TakePlace(const Rig& rig, const MaskLayout& layout, double delay_ms, PlaceDone done);
  bool Busy() const { return delay_ || place_; }
  /// The camera's picture, and when it was there. REQUIRES: Busy().
  void Seen(const Grey& picture, vm::Time arrived);
  /// Ends what is being measured, if anything, with this error.
  void Cancel(const vm::Error& error);
  /// Ends it and tells nobody.
  void Drop();

 private:
  struct DelayFlashes {
    fsm::Image dark, bright;
    DelayMeter meter{};
    bool on = true;  // the first flash to be shown is the other one
    DelayDone done{};
  };
  struct PlacePattern {
    PlacePattern(const Rig& rig, const MaskLayout& mask, double settle_ms, PlaceDone end)
        : dots(rig.projector_width(), rig.projector_height()),
          taker(dots, settle_ms),
          layout(mask),
          done(std::move(end)) {}
    PlacePattern(const PlacePattern&) = delete;  // the taker refers to the dots
    DotPattern dots;
    PlaceTaker taker;
    MaskLayout layout;
    PlaceDone done;
  };
  void Flash();
  void NextFrame();
  void EndDelay(const vm::Result<double>& delay_ms);
  void EndPlace(const vm::Result<Place>& place);
  void CancelTimers();

  vm::Scheduler& scheduler_;
  const std::function<void(const fsm::Image& frame)> show_;
  std::optional<DelayFlashes> delay_;
  std::optional<PlacePattern> place_;
  vm::TimerId flash_timer_ = 0, end_timer_ = 0;
};

}  // namespace hypermask
