#pragma once

#include <functional>
#include <memory>
#include <string>

#include "fsm/app/face_view.h"
#include "fsm/app/frame_series.h"
#include "fsm/film/picture_sender.h"
#include "vm_protocol/core/timer.h"

namespace fsm {

/// Pictures of the face for a program that looks on, beside any film: docs/face.md, Pictures for
/// other programs. Picture k shows the face at start + k / rate; those for which the machine or the
/// receiver is too late are left out, as are those that would look like the one before, down to one
/// each kStillLimit. Thread: the scheduler's; a timer is pending while there is a receiver.
class PictureStream {
 public:
  static constexpr vm::Time kStillLimit{500'000};

  using Draw = std::function<vm::Result<void>(vm::Time at)>;
  /// Whether the face may look otherwise at the second instant than at the first.
  using Moves = std::function<bool(vm::Time from, vm::Time to)>;
  using OnFailure = std::function<void(const vm::Error&)>;
  PictureStream(vm::Scheduler& clock, FaceView& view, Draw draw, Moves moves, OnFailure on_failure);

  /// "unix:PATH" of a socket somebody listens at, or "NONE"; the receiver before is let go.
  /// Errors: kBadValue, kUnavailable; there is no receiver then.
  vm::Result<void> SendTo(const std::string& to, int per_second);
  /// The receiver as SendTo was given it; "NONE" once it has gone.
  std::string to();
  /// Something was said to the face, which may look otherwise now.
  void Touch() { touched_ = true; }

 private:
  void Tick();
  /// False if it failed, which has been told.
  bool DrawAndSend(vm::Time at);
  void LetGo();

  vm::Scheduler& clock_;
  FaceView& view_;
  Draw draw_;
  Moves moves_;
  OnFailure on_failure_;
  std::unique_ptr<PictureSender> sender_;  // null while there is no receiver
  std::string to_;
  FrameSeries series_;
  long next_ = 0;
  vm::Time sent_{0};  // the instant of the last picture
  bool touched_ = true;
  vm::Timer timer_{clock_};
};

}  // namespace fsm
