#include "fsm/motion/mouth_stream.h"

#include <algorithm>

#include "fsm/motion/easing.h"

namespace fsm {
namespace {

constexpr vm::Time kRelease{300'000};  // as the speech of a text lets go

}  // namespace

vm::Time MouthStream::GoneAt(const Frame& last) { return last.at + kHold + kClose + kRelease; }

vm::Result<void> MouthStream::Add(vm::Time now, vm::Time at, const MouthPose& pose) {
  while (frames_.size() > 1 && GoneAt(frames_[1]) < now) frames_.pop_front();
  while (!frames_.empty() && frames_.back().at >= at) frames_.pop_back();
  if (frames_.size() >= kMostFrames) {
    return vm::Fail(vm::Errc::kLimit, "more than " + std::to_string(kMostFrames) +
                                          " frames of the mouth wait for their time");
  }
  const bool follows = !frames_.empty() && at - frames_.back().at <= kLongestGap;
  frames_.push_back({at, follows ? frames_.back().run_start : at, pose});
  return {};
}

void MouthStream::Stop(vm::Time now) {
  const SpokenMouth mouth = MouthAt(now);
  while (!frames_.empty() && frames_.back().at > now) frames_.pop_back();
  // Without this frame it would go back to the last one before holding there.
  if (!frames_.empty() && mouth.share == 1 && frames_.back().at < now) {
    frames_.push_back({now, frames_.back().run_start, mouth.pose});
  }
}

SpokenMouth MouthStream::MouthAt(vm::Time t) const {
  SpokenMouth mouth;
  const auto next = std::ranges::upper_bound(frames_, t, {}, &Frame::at);
  if (next != frames_.begin()) {
    const Frame& last = *(next - 1);
    const bool within = next != frames_.end() && next->run_start != next->at;
    if (within) {
      return {1, Mix(last.pose, next->pose, Progress(t, last.at, next->at - last.at))};
    }
    mouth.share = 1 - SmoothStep(Progress(t, last.at + kHold + kClose, kRelease));
    mouth.pose = Mix(last.pose, ClosedMouth(), SmoothStep(Progress(t, last.at + kHold, kClose)));
  }
  if (next != frames_.end()) {  // the first frame of a run is near
    mouth.Cover(next->pose, SmoothStep(Progress(t, next->at - kTakeOver, kTakeOver)));
  }
  return mouth;
}

void MouthStream::Contribute(vm::Time t, MotionFrame& frame) const {
  if (frames_.empty()) return;
  const SpokenMouth mouth = MouthAt(t);
  if (mouth.share <= 0) return;
  frame.Give("speaking", mouth.share);
  frame.Give("stream_taken", mouth.share);
  mouth.Contribute(settings_.mouth_scale, "mouth_stream", frame);
}

std::optional<vm::Time> MouthStream::NextActivity(vm::Time t) const {
  const auto next = std::ranges::upper_bound(frames_, t, {}, &Frame::at);
  if (next != frames_.begin() && t < GoneAt(*(next - 1))) return t;
  if (next == frames_.end()) return std::nullopt;
  return std::max(t, next->at - kTakeOver);
}

vm::Time MouthStream::FiniteEnd(vm::Time t) const {
  return frames_.empty() ? t : std::max(t, GoneAt(frames_.back()));
}

}  // namespace fsm
