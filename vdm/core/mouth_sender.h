#pragma once

#include <functional>
#include <optional>
#include <string>

#include "vdm/net/mouth_frame.h"
#include "vdm/prosody/head_net.h"
#include "vm_protocol/core/scheduler.h"

namespace vdm {

/// Decides which frames a face needs to be told, and counts their time from starts: while the mouth
/// moves a frame each kEvery, and nothing while it rests. A run begins with the last frame of rest
/// and ends when the mouth has rested for kRest. A long run is given a new start now and then, so
/// that clocks that drift stay together. Pure.
class MouthSender {
 public:
  static constexpr vm::Time kEvery{20'000};
  static constexpr vm::Time kRest{300'000};
  static constexpr vm::Time kLongestRun{10'000'000};

  struct Events {
    /// Frames are counted in ms from `at` on.
    std::function<void(vm::Time at)> start;
    std::function<void(double ms, const MouthFrame& frame, const std::optional<HeadPose>& head)>
        frame;
    /// The mouth begins to move, or rests.
    std::function<void(bool moving)> moving;
  };
  explicit MouthSender(Events events) : events_(std::move(events)) {}

  /// The mouth at `at`, and the head if it moves with it. Times rise; where one does not, what was
  /// said of later instants is no longer true, and a start says so.
  void Add(vm::Time at, const MouthFrame& frame, const std::optional<HeadPose>& head = {});
  /// The sound has ended or begins anew: a run that is going on ends with a closed mouth. The head
  /// is left where it is: the face takes it home.
  void Finish();
  bool moving() const { return start_.has_value(); }
  /// The time of the last frame; 0 before the first.
  vm::Time last() const { return last_; }

 private:
  void Begin(vm::Time at);
  void Send(vm::Time at, const MouthFrame& frame, const std::optional<HeadPose>& head);

  const Events events_;
  std::optional<vm::Time> start_;
  vm::Time last_{0};    // said last
  vm::Time active_{0};  // when the mouth moved last
  struct Still {
    vm::Time at;
    MouthFrame frame;
    std::optional<HeadPose> head;
  };
  std::optional<Still> before_;   // the last frame that was not said
  std::optional<HeadPose> head_;  // said last
};

/// The 19 numbers of a frame as the face's slot MouthFrame takes them, behind `ms`; with a head 4
/// more.
std::string FrameText(double ms, const MouthFrame& frame,
                      const std::optional<HeadPose>& head = std::nullopt);

}  // namespace vdm
