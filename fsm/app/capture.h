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

/// Numbered pictures of one utterance: DIR/PREFIX00001.bmp and on, from its begin to its end, at a
/// given rate. Picture k shows the face at begin + k / rate exactly; none is left out, and none
/// stands for an instant after the end, however late the machine is. Each is drawn in a turn of the
/// scheduler of its own, so that commands and signals are heard between two of them.
/// Limits: those of Limits, then it ends as a failure. Thread: the scheduler's.
class Capture {
 public:
  struct Limits {
    long pictures = 36'000;             ///< 20 minutes at 30 a second
    std::uintmax_t bytes = 8ULL << 30;  ///< on the disk: 10,000 pictures of 512 x 512
  };
  struct Order {
    std::string folder;
    std::string prefix;
    double per_second = 30;
    std::string ending = ".bmp";
  };
  using Draw = std::function<vm::Result<void>(long number, vm::Time at)>;
  /// Told once all pictures of an utterance are written; by an error, if they are not.
  using OnEnd = std::function<void(const vm::Result<void>&)>;
  /// Lifetime: clock, view and files outlive it.
  Capture(vm::Scheduler& clock, FaceView& view, const MediaFiles& files, Draw draw, OnEnd on_end)
      : Capture(clock, view, files, std::move(draw), std::move(on_end), Limits{}) {}
  Capture(vm::Scheduler& clock, FaceView& view, const MediaFiles& files, Draw draw, OnEnd on_end,
          Limits limits)
      : files_(files),
        draw_(std::move(draw)),
        on_end_(std::move(on_end)),
        queue_(view, [this](const Image& picture, long) { return Write(picture); }),
        limits_(limits),
        timer_(clock) {}
  ~Capture() { Cancel(); }

  void Arm(Order order);
  void Begin(vm::Time at);  ///< the utterance begins, now or just before; nothing if not armed
  /// The utterance was over at `at`, now or before: the pictures due until then that are still
  /// missing follow, then on_end is called. Nothing if none are being made.
  void End(vm::Time at);
  void Cancel();  ///< without a word; the pictures drawn until then are written
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
  const Limits limits_;
  Order order_;
  FrameSeries series_;
  bool armed_ = false;
  bool running_ = false;
  std::optional<vm::Time> end_;  // of the utterance, once it is known
  long next_ = 0;                // to be drawn
  long written_ = 0;             // and what they take
  std::uintmax_t bytes_ = 0;
  vm::Timer timer_;
};

}  // namespace fsm
