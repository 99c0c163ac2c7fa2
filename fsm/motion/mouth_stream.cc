#include "fsm/motion/mouth_stream.h"

#include <algorithm>
#include <cmath>

#include "fsm/motion/easing.h"
#include "fsm/motion/speech_motion.h"

namespace fsm {

vm::Time MouthStream::GoneAt(const Frame& last) {
  const vm::Time mouth = kHold + kClose + SpeechMotion::kRelease;
  return last.at + (last.head ? std::max(mouth, kHeadHome) : mouth);
}

vm::Result<void> MouthStream::Add(vm::Time now, vm::Time at, const MouthPose& pose,
                                  const std::optional<StreamHead>& head) {
  while (frames_.size() > 1 && GoneAt(frames_[1]) < now) frames_.pop_front();
  while (!frames_.empty() && frames_.back().at >= at) frames_.pop_back();
  if (frames_.size() >= kMostFrames) {
    return vm::Fail(vm::Errc::kLimit, "more than " + std::to_string(kMostFrames) +
                                          " frames of the mouth wait for their time");
  }
  const bool follows = !frames_.empty() && at - frames_.back().at <= kLongestGap;
  frames_.push_back({at, follows ? frames_.back().run_start : at, pose, head});
  return {};
}

void MouthStream::Stop(vm::Time now) {
  const SpokenMouth mouth = MouthAt(now);
  const HeadShare head = HeadAt(now);
  const bool cut = !frames_.empty() && frames_.back().at > now;
  while (!frames_.empty() && frames_.back().at > now) frames_.pop_back();
  // Without this frame it would go back to the last one before holding there, or jump to rest where
  // a run was about to take it over.
  if ((cut ? mouth.share > 0 : mouth.share == 1) && (frames_.empty() || frames_.back().at < now)) {
    frames_.push_back({now, frames_.empty() ? now : frames_.back().run_start, mouth.pose,
                       head.share > 0 ? std::optional(head.pose) : std::nullopt, mouth.share});
  }
}

SpokenMouth MouthStream::MouthAt(vm::Time t) const {
  SpokenMouth mouth;
  const auto next = std::ranges::upper_bound(frames_, t, {}, &Frame::at);
  if (next != frames_.begin()) {
    const Frame& last = *(next - 1);
    const bool within = next != frames_.end() && next->run_start != next->at;
    if (within) {
      const double progress = Progress(t, last.at, next->at - last.at);
      return {std::lerp(last.share, next->share, progress), Mix(last.pose, next->pose, progress)};
    }
    mouth.share =
        last.share * (1 - Eased(Progress(t, last.at + kHold + kClose, SpeechMotion::kRelease)));
    mouth.pose = Mix(last.pose, ClosedMouth(), Eased(Progress(t, last.at + kHold, kClose)));
  }
  if (next != frames_.end()) {  // the next run may be fading in
    mouth.Cover(next->pose, Eased(Progress(t, next->at - kTakeOver, kTakeOver)));
  }
  return mouth;
}

MouthStream::HeadShare MouthStream::HeadAt(vm::Time t) const {
  HeadShare head;
  const auto next = std::ranges::upper_bound(frames_, t, {}, &Frame::at);
  if (next != frames_.begin()) {
    const Frame& last = *(next - 1);
    if (next != frames_.end() && next->run_start != next->at) {
      return Between(HeadOf(last), HeadOf(*next), Progress(t, last.at, next->at - last.at));
    }
    head = Between(HeadOf(last), HeadShare{}, Eased(Progress(t, last.at, kHeadHome)));
  }
  if (next != frames_.end()) {
    head = Between(head, HeadOf(*next), Eased(Progress(t, next->at - kTakeOver, kTakeOver)));
  }
  return head;
}

void MouthStream::Contribute(vm::Time t, MotionLayers& layers) const {
  if (frames_.empty()) return;
  if (const HeadShare head = HeadAt(t); head.share > 0) {
    layers.AddSignal("head_taken", head.share);
    MotionLayer& gestures = layers.Layer("stream_gestures");
    gestures.head = head.pose.angles;
    for (const Side side : kSides) {
      gestures.units.au[side][kInnerBrowRaiser] =
          static_cast<float>(SpeechMotion::kInnerBrow) * head.pose.brow;
      gestures.units.au[side][kOuterBrowRaiser] =
          static_cast<float>(SpeechMotion::kOuterBrow) * head.pose.brow;
    }
  }
  const SpokenMouth mouth = MouthAt(t);
  if (mouth.share <= 0) return;
  layers.AddSignal("speaking", mouth.share);
  layers.AddSignal("stream_taken", mouth.share);
  mouth.Contribute(mouth_scale_.At(t), "mouth_stream", layers);
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
