#pragma once

#include <deque>
#include <optional>

#include "fsm/motion/motion_settings.h"
#include "fsm/motion/motion_source.h"
#include "fsm/motion/spoken_mouth.h"
#include "vm_protocol/core/result.h"

namespace fsm {

/// What head and brows do with a mouth that another program gives.
struct StreamHead {
  Angles angles{};
  float brow = 0;  ///< strength of units 1 and 2, 0..1
};
inline StreamHead Mix(const StreamHead& a, const StreamHead& b, double share_of_b) {
  return {Mix(a.angles, b.angles, share_of_b), Mix(a.brow, b.brow, share_of_b)};
}

/// The mouth as another program gives it, frame by frame, each with its time (MouthFrame): of a
/// voice that nobody told the text of, or of a film. It is on the layer `mouth_stream` and gives
/// the signals of speech, `speaking`, `lips_taken` and `contact`, and `stream_taken`, by which the
/// mouth of a text gives way. Frames may say what head and brows do with it too: that is on the
/// layer `stream_gestures`, and `head_taken` says that it is so.
///
/// Between two frames up to kLongestGap apart it goes straight from one to the other; such frames
/// are a run. A run takes the mouth over within kTakeOver before its first frame. After its last
/// frame the mouth holds for kHold, closes within kClose and is let go: so it rests when no frames
/// come any more, for whatever reason. Head and brows go home within kHeadHome.
/// Commands come in order of time; queries are for now or later.
/// Limits: kMostFrames that are still to come.
class MouthStream : public MotionSource {
 public:
  static constexpr vm::Time kLongestGap{200'000};
  static constexpr vm::Time kTakeOver{60'000};
  static constexpr vm::Time kHold{120'000};
  static constexpr vm::Time kClose{110'000};
  static constexpr vm::Time kHeadHome{700'000};        ///< as after the speech of a text
  static constexpr std::size_t kMostFrames = 180'000;  ///< an hour at 50 a second

  /// A frame for the instant `at`, at full articulation; frames for that instant and later that
  /// came before are forgotten. Error: kLimit.
  vm::Result<void> Add(vm::Time now, vm::Time at, const MouthPose& pose,
                       const std::optional<StreamHead>& head = std::nullopt);
  /// The instant from which those who give frames count their times.
  vm::Time start() const { return start_; }
  void set_start(vm::Time start) { start_ = start; }
  /// Another MouthScale comes about without a jump.
  void SetMouthScale(vm::Time now, double mouth_scale) {
    mouth_scale_.MoveTo(now, static_cast<float>(mouth_scale), kMouthScaleMove);
  }
  /// Forgets the frames after `now`; the mouth holds, closes and is let go from there.
  void Stop(vm::Time now);

  void Contribute(vm::Time t, MotionLayers& layers) const override;
  std::optional<vm::Time> NextActivity(vm::Time t) const override;
  vm::Time FiniteEnd(vm::Time t) const override;

 private:
  struct Frame {
    vm::Time at;
    vm::Time run_start;
    MouthPose pose;
    std::optional<StreamHead> head;
    double share = 1;  // how far mouth and head have been taken over
  };
  SpokenMouth MouthAt(vm::Time t) const;
  struct HeadShare {
    double share = 0;  // how much it is said by frames, 0..1
    StreamHead pose;   // times the share already
  };
  HeadShare HeadAt(vm::Time t) const;
  static HeadShare HeadOf(const Frame& frame) {
    return {frame.head ? frame.share : 0.0, frame.head.value_or(StreamHead{})};
  }
  static HeadShare Between(const HeadShare& a, const HeadShare& b, double share_of_b) {
    return {a.share + (b.share - a.share) * share_of_b, fsm::Mix(a.pose, b.pose, share_of_b)};
  }
  static vm::Time GoneAt(const Frame& last);

  vm::Time start_{0};
  Track<float> mouth_scale_{static_cast<float>(MotionSettings{}.mouth_scale)};
  std::deque<Frame> frames_;  // by `at`
};

}  // namespace fsm
