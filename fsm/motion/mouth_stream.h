#pragma once

#include <deque>
#include <optional>

#include "fsm/motion/motion_settings.h"
#include "fsm/motion/motion_source.h"
#include "fsm/motion/spoken_mouth.h"
#include "vm_protocol/core/result.h"

namespace fsm {

/// The mouth as another program gives it, frame by frame, each with its time (MouthFrame): of a
/// voice that nobody told the text of, or of a film. It is on the layer `mouth_stream` and gives
/// the signals of speech, `speaking`, `lips_taken` and `contact`, and `stream_taken`, by which the
/// mouth of a text gives way.
///
/// Between two frames up to kLongestGap apart it goes straight from one to the other; such frames
/// are a run. A run takes the mouth over within kTakeOver before its first frame. After its last
/// frame the mouth holds for kHold, closes within kClose and is let go: so it rests when no frames
/// come any more, for whatever reason.
/// Lifetime: `settings` outlives it. Commands come in order of time; queries are for now or later.
/// Limits: kMostFrames that are still to come.
class MouthStream : public MotionSource {
 public:
  static constexpr vm::Time kLongestGap{200'000};
  static constexpr vm::Time kTakeOver{60'000};
  static constexpr vm::Time kHold{120'000};
  static constexpr vm::Time kClose{110'000};
  static constexpr std::size_t kMostFrames = 180'000;  ///< an hour at 50 a second

  explicit MouthStream(const MotionSettings& settings) : settings_(settings) {}

  /// A frame for the instant `at`, at full articulation; frames for that instant and later that
  /// came before are forgotten. Error: kLimit.
  vm::Result<void> Add(vm::Time now, vm::Time at, const MouthPose& pose);
  /// Forgets the frames after `now`; the mouth holds, closes and is let go from there.
  void Stop(vm::Time now);

  void Contribute(vm::Time t, MotionFrame& frame) const override;
  std::optional<vm::Time> NextActivity(vm::Time t) const override;
  vm::Time FiniteEnd(vm::Time t) const override;

 private:
  struct Frame {
    vm::Time at;
    vm::Time run_start;
    MouthPose pose;
  };
  SpokenMouth MouthAt(vm::Time t) const;
  static vm::Time GoneAt(const Frame& last);

  const MotionSettings& settings_;
  std::deque<Frame> frames_;  // by `at`
};

}  // namespace fsm
