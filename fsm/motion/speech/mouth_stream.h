#pragma once

#include <cmath>
#include <deque>
#include <optional>

#include "fsm/motion/base/motion_source.h"
#include "fsm/motion/inputs/motion_inputs.h"
#include "fsm/motion/speech/speech_timing.h"
#include "fsm/motion/speech/spoken_mouth.h"
#include "vm_protocol/core/result.h"

namespace fsm {

/// Head and brows of a frame of MouthStream.
struct StreamHead {
  Angles angles{};
  float brow = 0;  ///< strength of units 1 and 2, 0..1
};
inline StreamHead Mix(const StreamHead& a, const StreamHead& b, double share_of_b) {
  return {Mix(a.angles, b.angles, share_of_b), Mix(a.brow, b.brow, share_of_b)};
}

/// Moves the mouth by frames that another program sends, each with its time (slot MouthFrame), for
/// instance from a film or from a voice whose text is unknown. The mouth is on the layer
/// `mouth_stream`. Gives the signals `speaking`, `lips_taken` and `contact` as SpeechMotion does,
/// and `stream_taken`, by which the mouth of SpeechMotion is reduced. Frames may move head and
/// brows as well, on the layer `stream_gestures`; the signal `head_taken` is then above 0.
///
/// Frames at most kMaxGap apart form a run, within which frames are interpolated linearly. A
/// run fades in during the kMouthFadeIn before its first frame. After its last frame the mouth
/// holds for kHold, closes within kMouthCloses and fades out; it therefore rests whenever frames
/// stop, for whatever reason. Head and brows return to rest within kHeadReturns. Commands come in
/// order of time; queries are for the time of the last command or later. Limits: kMaxFrames frames
/// in the future.
class MouthStream : public MotionSource {
 public:
  static constexpr vm::Time kMaxGap{200'000};
  static constexpr vm::Time kHold{120'000};
  static constexpr std::size_t kMaxFrames = 180'000;  ///< an hour at 50 frames per second

  /// `in` outlives this.
  explicit MouthStream(const MotionInputs& in) : mouth_scale_(in.mouth_scale) {}

  /// Adds a frame for the instant `at`, its pose at full articulation; drops earlier added frames
  /// for that instant or later. Error: kLimit.
  vm::Result<void> Add(vm::Time now, vm::Time at, const MouthPose& pose,
                       const std::optional<StreamHead>& head = std::nullopt);
  /// The instant from which senders count the times of frames; Add does not use it.
  vm::Time start() const { return start_; }
  void set_start(vm::Time start) { start_ = start; }
  /// Drops the frames after `now`; from there the mouth holds, closes and is released.
  void Stop(vm::Time now);

  void Contribute(vm::Time t, MotionLayers& layers) const override;
  std::optional<vm::Time> NextMotion(vm::Time t) const override;
  vm::Time EndsAt(vm::Time t) const override;

 private:
  struct Frame {
    vm::Time time;
    vm::Time run_start;
    MouthPose pose;
    std::optional<StreamHead> head;
    double weight = 1;  // how far mouth and head have been taken over
  };
  struct WeightedHead {
    double weight = 0;  // how far frames control head and brows, 0..1
    StreamHead pose;    // multiplied by the weight
    friend WeightedHead Mix(const WeightedHead& a, const WeightedHead& b, double share_of_b) {
      return {std::lerp(a.weight, b.weight, share_of_b), Mix(a.pose, b.pose, share_of_b)};
    }
  };
  /// Returns a value at `t`, given that of a frame and how it fades after the last frame of a run.
  template <typename Value, typename OfFrame, typename AfterLast>
  Value At(vm::Time t, const OfFrame& of_frame, const AfterLast& after_last) const;
  SpokenMouth MouthAt(vm::Time t) const;
  WeightedHead HeadAt(vm::Time t) const;
  static vm::Time FadedAt(const Frame& last);

  vm::Time start_{0};
  const Track<float>& mouth_scale_;
  std::deque<Frame> frames_;  // by `time`
};

}  // namespace fsm
