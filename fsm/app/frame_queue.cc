#include "fsm/app/frame_queue.h"

namespace fsm {

vm::Result<void> FrameQueue::Add() {
  waiting_.push_back({view_.BeginRead(), 1});
  return waiting_.size() > kMaxWaiting ? PassOnFirst() : vm::Result<void>{};
}

vm::Result<void> FrameQueue::Repeat() {
  if (waiting_.empty()) return take_(last_, 1);
  ++waiting_.back().times;
  return {};
}

vm::Result<void> FrameQueue::Flush() {
  vm::Result<void> taken;
  while (taken && !waiting_.empty()) taken = PassOnFirst();
  return taken;
}

void FrameQueue::Clear() {
  for (const Waiting& one : waiting_) view_.DropRead(one.frame);
  waiting_.clear();
}

vm::Result<void> FrameQueue::PassOnFirst() {
  const Waiting first = waiting_.front();
  waiting_.pop_front();
  auto taken = view_.EndRead(first.frame, last_);
  if (taken) taken = take_(last_, first.times);
  if (!taken) Clear();
  return taken;
}

}  // namespace fsm
