#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <utility>

#include "fsm/app/face_view.h"

namespace fsm {

/// The frames of a series on their way from the card: each is handed on once some more are drawn,
/// or by Flush, all of them in order. Which frame is handed on when depends on nothing but the
/// calls.
/// Lifetime: `view` outlives it. Thread: the view's.
class FrameQueue {
 public:
  static constexpr std::size_t kMostWaiting = 2;

  /// Takes a frame, `times` times; 1 or more. An error ends the series.
  using Take = std::function<vm::Result<void>(const Image& frame, long times)>;
  FrameQueue(FaceView& view, Take take) : view_(view), take_(std::move(take)) {}
  ~FrameQueue() { Clear(); }
  FrameQueue(const FrameQueue&) = delete;
  FrameQueue& operator=(const FrameQueue&) = delete;

  /// The frame that the view drew last. `wait`: off, it is handed on at once, after those before
  /// it. Error: that of handing on one or one before; those after it are dropped.
  vm::Result<void> Add(bool wait = true);
  /// The frame added last once more. REQUIRES: there is one.
  vm::Result<void> Repeat();
  /// Hands on what waits. Error: as Add.
  vm::Result<void> Flush();
  /// Drops what waits.
  void Clear();

 private:
  struct Waiting {
    std::uint64_t frame;
    long times;
  };
  vm::Result<void> HandOnFirst();

  FaceView& view_;
  Take take_;
  std::deque<Waiting> waiting_;
  Image last_;  // handed on
};

}  // namespace fsm
