#include "fsm/film/frame_feeder.h"

#include <utility>

namespace fsm {

FrameFeeder::~FrameFeeder() {
  if (!thread_.joinable()) return;
  {
    const std::lock_guard lock(mutex_);
    waiting_.clear();
    closed_ = true;
  }
  ffmpeg_.CancelWrites();
  changed_.notify_all();
  thread_.join();
}

std::vector<std::uint8_t> FrameFeeder::TakeSpare() {
  const std::lock_guard lock(mutex_);
  if (spare_.empty()) return {};
  auto frame = std::move(spare_.back());
  spare_.pop_back();
  return frame;
}

vm::Result<void> FrameFeeder::Add(std::vector<std::uint8_t> frame) {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return waiting_.size() < kMaxWaiting || !state_; });
  if (!state_) return state_;
  waiting_.push_back(std::move(frame));
  changed_.notify_all();
  return {};
}

vm::Result<void> FrameFeeder::Close() {
  {
    const std::lock_guard lock(mutex_);
    closed_ = true;
  }
  changed_.notify_all();
  if (thread_.joinable()) thread_.join();
  return state_;
}

void FrameFeeder::Run() {
  std::unique_lock lock(mutex_);
  for (;;) {
    changed_.wait(lock, [this] { return !waiting_.empty() || closed_; });
    if (waiting_.empty()) return;
    auto frame = std::move(waiting_.front());
    waiting_.pop_front();
    lock.unlock();
    auto written = ffmpeg_.Write(frame);
    lock.lock();
    spare_.push_back(std::move(frame));
    if (!written) {
      state_ = std::move(written);
      waiting_.clear();
      changed_.notify_all();
      return;
    }
    changed_.notify_all();
  }
}

}  // namespace fsm
