#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <mutex>
#include <thread>
#include <vector>

#include "fsm/film/ffmpeg_process.h"
#include "vm_protocol/core/result.h"

namespace fsm {

/// Writes frames to an ffmpeg process from a separate thread, so that drawing continues while the
/// encoder works. Frames arrive whole and in order.
/// Lifetime: `ffmpeg` outlives this and is not to be touched until Close() or the destructor, which
///           end the thread. Thread: one caller.
/// Limits: kMaxWaiting frames wait; Add blocks while the queue is full.
class FrameFeeder {
 public:
  static constexpr std::size_t kMaxWaiting = 8;

  explicit FrameFeeder(FfmpegProcess& ffmpeg) : ffmpeg_(ffmpeg), thread_([this] { Run(); }) {}
  /// Drops the waiting frames.
  ~FrameFeeder();
  FrameFeeder(const FrameFeeder&) = delete;
  FrameFeeder& operator=(const FrameFeeder&) = delete;

  /// Returns an empty frame, with the memory of an earlier one if possible.
  std::vector<std::uint8_t> TakeSpare();
  /// Error: kUnavailable, which may be that of an earlier frame.
  vm::Result<void> Add(std::vector<std::uint8_t> frame);
  /// Waits until all frames are written. Error: as Add.
  vm::Result<void> Close();

 private:
  void Run();

  FfmpegProcess& ffmpeg_;
  std::mutex mutex_;
  std::condition_variable changed_;
  // Guarded by mutex_.
  std::deque<std::vector<std::uint8_t>> waiting_;
  std::vector<std::vector<std::uint8_t>> spare_;
  vm::Result<void> state_;
  bool closed_ = false;
  std::thread thread_;  // last: it uses all of the above
};

}  // namespace fsm
