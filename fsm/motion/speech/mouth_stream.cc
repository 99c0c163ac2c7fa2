#include "fsm/motion/speech/mouth_stream.h"

#include <algorithm>
#include <cmath>

#include "fsm/motion/base/easing.h"
#include "fsm/motion/base/layer_names.h"
#include "fsm/motion/speech/speech_timing.h"

namespace fsm {

vm::Time MouthStream::FadedAt(const Frame& last) {
  const vm::Time mouth = kHold + kMouthCloses + kMouthFadeOut;
  return last.time + (last.head ? std::max(mouth, kHeadReturns) : mouth);
}

vm::Result<void> MouthStream::Add(vm::Time now, vm::Time at, const MouthPose& pose,
                                  const std::optional<StreamHead>& head) {
  while (frames_.size() > 1 && FadedAt(frames_[1]) < now) frames_.pop_front();
  while (!frames_.empty() && frames_.back().time >= at) frames_.pop_back();
  if (frames_.size() >= kMaxFrames) {
    return vm::Fail(vm::Errc::kLimit, "more than " + std::to_string(kMaxFrames) +
                                          " frames of the mouth wait for their time");
  }
  const bool follows = !frames_.empty() && at - frames_.back().time <= kMaxGap;
  frames_.push_back({at, follows ? frames_.back().run_start : at, pose, head});
  return {};
}

void MouthStream::Stop(vm::Time now) {
  const SpokenMouth mouth = MouthAt(now);
  const WeightedHead head = HeadAt(now);
  const bool cut = !frames_.empty() && frames_.back().time > now;
  while (!frames_.empty() && frames_.back().time > now) frames_.pop_back();
  // Without this frame the mouth would go back to the last frame before it holds, or jump to rest
  // where a new run was fading in.
  if ((cut ? mouth.weight > 0 : mouth.weight == 1) &&
      (frames_.empty() || frames_.back().time < now)) {
    frames_.push_back({now, frames_.empty() ? now : frames_.back().run_start, mouth.pose,
                       head.weight > 0 ? std::optional(head.pose) : std::nullopt, mouth.weight});
  }
}

template <typename Value, typename OfFrame, typename AfterLast>
Value MouthStream::At(vm::Time t, const OfFrame& of_frame, const AfterLast& after_last) const {
  Value value;
  const auto next = std::ranges::upper_bound(frames_, t, {}, &Frame::time);
  if (next != frames_.begin()) {
    const Frame& last = *(next - 1);
    if (next != frames_.end() && next->run_start != next->time) {
      return Mix(of_frame(last), of_frame(*next), Progress(t, last.time, next->time - last.time));
    }
    value = after_last(last);
  }
  if (next == frames_.end()) return value;
  // The next run may be fading in.
  return Mix(value, of_frame(*next),
             SmoothStep(Progress(t, next->time - kMouthFadeIn, kMouthFadeIn)));
}

SpokenMouth MouthStream::MouthAt(vm::Time t) const {
  const auto of_frame = [](const Frame& frame) { return SpokenMouth{frame.weight, frame.pose}; };
  return At<SpokenMouth>(t, of_frame, [t](const Frame& last) -> SpokenMouth {
    const vm::Time closes = last.time + kHold;
    return {last.weight * (1 - SmoothStep(Progress(t, closes + kMouthCloses, kMouthFadeOut))),
            Mix(last.pose, ClosedMouth(), SmoothStep(Progress(t, closes, kMouthCloses)))};
  });
}

MouthStream::WeightedHead MouthStream::HeadAt(vm::Time t) const {
  const auto of_frame = [](const Frame& frame) -> WeightedHead {
    return {frame.head ? frame.weight : 0.0, frame.head.value_or(StreamHead{})};
  };
  return At<WeightedHead>(t, of_frame, [&](const Frame& last) {
    return Mix(of_frame(last), {}, SmoothStep(Progress(t, last.time, kHeadReturns)));
  });
}

void MouthStream::Contribute(vm::Time t, MotionLayers& layers) const {
  if (frames_.empty()) return;
  if (const WeightedHead head = HeadAt(t); head.weight > 0) {
    layers.AddSignal(SignalName::kHeadTaken, head.weight);
    MotionLayer& gestures = layers.Layer(LayerName::kStreamGestures);
    gestures.head_rotation = head.pose.angles;
    for (const Side side : kSides) {
      gestures.look.au[side][kInnerBrowRaiser] =
          static_cast<float>(kInnerBrowRaise) * head.pose.brow;
      gestures.look.au[side][kOuterBrowRaiser] =
          static_cast<float>(kOuterBrowRaise) * head.pose.brow;
    }
  }
  const SpokenMouth mouth = MouthAt(t);
  if (mouth.weight <= 0) return;
  layers.AddSignal(SignalName::kSpeaking, mouth.weight);
  layers.AddSignal(SignalName::kStreamTaken, mouth.weight);
  mouth.Contribute(mouth_scale_.At(t), LayerName::kMouthStream, layers);
}

std::optional<vm::Time> MouthStream::NextMotion(vm::Time t) const {
  const auto next = std::ranges::upper_bound(frames_, t, {}, &Frame::time);
  if (next != frames_.begin() && t < FadedAt(*(next - 1))) return t;
  if (next == frames_.end()) return std::nullopt;
  return std::max(t, next->time - kMouthFadeIn);
}

vm::Time MouthStream::EndsAt(vm::Time t) const {
  return frames_.empty() ? t : std::max(t, FadedAt(frames_.back()));
}

}  // namespace fsm
