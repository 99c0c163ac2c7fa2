#include "fsm/app/capture.h"

#include <fmt/format.h>

namespace fsm {

void Capture::Arm(Order order) {
  Cancel();
  order_ = std::move(order);
  armed_ = true;
}

void Capture::Begin() {
  if (!armed_) return;
  armed_ = false;
  running_ = true;
  series_ = {clock_.Now(), order_.per_second};
  next_ = 0;
  Tick();
}

void Capture::Tick() {
  timer_ = 0;
  if (!WriteNext()) return;
  timer_ = clock_.At(series_.TimeOf(next_), [this] { Tick(); });
}

bool Capture::WriteNext() {
  if (next_ >= kMaxPictures) {
    running_ = false;
    on_failure_({vm::Errc::kLimit,
                 "Capture: more than " + std::to_string(kMaxPictures) + " pictures", 0});
    return false;
  }
  auto done = draw_(next_, series_.TimeOf(next_));
  if (done) {
    const std::string path =
        fmt::format("{}/{}{:05}{}", order_.folder, order_.prefix, next_ + 1, order_.ending);
    done = studio_.WritePicture(studio_.Read(), path);
  }
  if (!done) {
    running_ = false;
    on_failure_(done.error());
    return false;
  }
  ++next_;
  return true;
}

bool Capture::End() {
  if (!running_) return false;
  // Drawing takes time: what becomes due meanwhile is after the end.
  const vm::Time end = clock_.Now();
  while (series_.TimeOf(next_) <= end) {
    if (!WriteNext()) break;
  }
  Cancel();
  return true;
}

void Capture::Cancel() {
  if (timer_ != 0) clock_.Cancel(timer_);
  timer_ = 0;
  armed_ = false;
  running_ = false;
}

}  // namespace fsm
