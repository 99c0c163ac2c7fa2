#pragma once

#include <functional>
#include <string>

#include "fsm/app/frame_series.h"
#include "fsm/app/render_backend.h"
#include "vm_protocol/core/scheduler.h"

namespace fsm {

/// Numbered pictures of one utterance: DIR/PREFIX00001.bmp and on, from its begin to its end, at a
/// given rate. Picture k shows the face at begin + k / rate exactly; none is left out.
/// Limits: kMaxPictures, then it ends as a failure.
class Capture {
 public:
  static constexpr long kMaxPictures = 36'000;  ///< 20 minutes at 30 a second
  struct Order {
    std::string folder;
    std::string prefix;
    double per_second = 30;
    std::string ending = ".bmp";
  };
  using Draw = std::function<vm::Result<void>(long number, vm::Time at)>;
  using OnFailure = std::function<void(const vm::Error&)>;
  Capture(vm::Scheduler& clock, RenderBackend& studio, Draw draw, OnFailure on_failure)
      : clock_(clock),
        studio_(studio),
        draw_(std::move(draw)),
        on_failure_(std::move(on_failure)) {}
  ~Capture() { Cancel(); }

  void Arm(Order order);
  void Begin();  ///< the utterance begins; nothing if not armed
  /// The utterance is over: what is due is written, and it is armed no more. True if it was
  /// running.
  bool End();
  void Cancel();
  bool armed() const { return armed_; }
  bool running() const { return running_; }

 private:
  void Tick();
  bool WriteNext();

  vm::Scheduler& clock_;
  RenderBackend& studio_;
  Draw draw_;
  OnFailure on_failure_;
  Order order_;
  FrameSeries series_;
  bool armed_ = false;
  bool running_ = false;
  long next_ = 0;
  vm::TimerId timer_ = 0;
};

}  // namespace fsm
