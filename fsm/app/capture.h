#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "fsm/app/frame_queue.h"
#include "fsm/app/frame_series.h"
#include "fsm/app/media_files.h"
#include "vm_protocol/core/timer.h"

namespace fsm {

struct CaptureLimits {
  long pictures = 36'000;             ///< 20 minutes at 30 per second
  std::uintmax_t bytes = 8ULL << 30;  ///< on the disk: 10,000 pictures of 512 x 512
};

/// Writes numbered pictures of one utterance, DIR/PREFIX00001.bmp and on, from its begin to its
/// end, at a given rate. Picture k shows the face at begin + k / rate exactly; none is skipped, and
/// none is later than the end, however slow the machine is. Each is drawn in a separate task of the
/// scheduler, so that commands and signals are handled between pictures.
/// Limits: those of CaptureLimits; exceeding one ends the capture with an error. Thread: the
/// scheduler's.
class Capture {
 public:
  struct Request {
    std::string folder;
    std::string prefix;
    double per_second = 30;
    std::string ending = ".bmp";
  };
  using Draw = std::function<vm::Result<void>(long number, vm::Time at)>;
  /// Called once all pictures of an utterance are written, or with an error if they cannot be.
  using OnEnd = std::function<void(const vm::Result<void>&)>;
  /// Lifetime: clock, view and files outlive this.
  Capture(vm::Scheduler& clock, FaceView& view, const MediaFiles& files, Draw draw, OnEnd on_end,
          CaptureLimits limits = {})
      : files_(files),
        draw_(std::move(draw)),
        on_end_(std::move(on_end)),
        queue_(view, [this](const Image& picture, long) { return Write(picture); }),
        limits_(limits),
        timer_(clock) {}
  ~Capture() { Cancel(); }

  void Arm(Request request);
  /// The utterance began at `at`, now or just before; no effect if not armed.
  void Begin(vm::Time at);
  /// Says that the utterance ended at `at`, now or before. The remaining pictures up to then are
  /// drawn, then on_end is called. No effect if no capture is running.
  void End(vm::Time at);
  void Cancel();  ///< does not call on_end; writes the pictures already drawn
  bool running() const { return running_; }

 private:
  void Tick();
  vm::Result<void> DrawNext();
  vm::Result<void> Write(const Image& picture);
  void WaitOrFinish();
  bool IsOver() const { return end_ && series_.TimeOf(next_) > *end_; }

  const MediaFiles& files_;
  Draw draw_;
  OnEnd on_end_;
  FrameQueue queue_;
  const CaptureLimits limits_;
  Request request_;
  FrameSeries series_;
  bool armed_ = false;
  bool running_ = false;
  std::optional<vm::Time> end_;  // of the utterance, once it is known
  long next_ = 0;                // the next picture to draw
  long written_ = 0;             // bytes_ counts their size
  std::uintmax_t bytes_ = 0;
  vm::Timer timer_;
};

}  // namespace fsm
