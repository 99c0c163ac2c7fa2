#include "face_editor/core/head_maker.h"

#include <utility>

namespace editor {

HeadMaker::HeadMaker() : thread_([this] { Work(); }) {}

HeadMaker::~HeadMaker() {
  {
    const std::lock_guard lock(mutex_);
    ended_ = true;
    next_ = nullptr;
  }
  wake_.notify_all();
  thread_.join();
}

void HeadMaker::Ask(Job job) {
  {
    const std::lock_guard lock(mutex_);
    next_ = std::move(job);
  }
  wake_.notify_all();
}

std::optional<vm::Result<MadeHead>> HeadMaker::Take() {
  const std::lock_guard lock(mutex_);
  return std::exchange(made_, std::nullopt);
}

bool HeadMaker::busy() const {
  const std::lock_guard lock(mutex_);
  return working_ || next_ || made_;
}

void HeadMaker::Work() {
  std::unique_lock lock(mutex_);
  while (true) {
    wake_.wait(lock, [this] { return ended_ || next_; });
    if (ended_) return;
    const Job job = std::exchange(next_, nullptr);
    working_ = true;
    lock.unlock();
    auto made = job();
    lock.lock();
    working_ = false;
    made_ = std::move(made);
  }
}

}  // namespace editor
