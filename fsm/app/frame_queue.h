#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <utility>

#include "fsm/app/face_view.h"

namespace fsm {

/// Reads frames of a series back from the GPU: passes each, in order, to `take` once
/// kMaxWaiting more are drawn, or by Flush. When a frame is passed on depends only on the calls.
/// Lifetime: `view` outlives this. Thread: the view's.
class FrameQueue {
 public:
  static constexpr std::size_t kMaxWaiting = 2;

  /// Receives a frame, which counts `times` times (1 or more). An error ends the series.
  using Take = std::function<vm::Result<void>(const Image& frame, long times)>;
  FrameQueue(FaceView& view, Take take) : view_(view), take_(std::move(take)) {}
  ~FrameQueue() { Clear(); }
  FrameQueue(const FrameQueue&) = delete;
  FrameQueue& operator=(const FrameQueue&) = delete;

  /// Adds the frame that the view drew last. Error: that of reading or `take`, for an earlier
  /// frame; all waiting frames are then dropped.
  vm::Result<void> Add();
  /// Adds the last frame once more. REQUIRES: there is one.
  vm::Result<void> Repeat();
  /// Passes on all waiting frames. Error: as Add.
  vm::Result<void> Flush();
  /// Drops all waiting frames.
  void Clear();

 private:
  struct Waiting {
    std::uint64_t frame;
    long times;
  };
  vm::Result<void> PassOnFirst();

  FaceView& view_;
  Take take_;
  std::deque<Waiting> waiting_;
  Image last_;  // the frame passed on last
};

}  // namespace fsm
