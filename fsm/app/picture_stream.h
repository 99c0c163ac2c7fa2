#pragma once

#include <functional>
#include <memory>
#include <string>

#include "fsm/app/face_view.h"
#include "fsm/app/frame_series.h"
#include "fsm/film/picture_sender.h"
#include "vm_protocol/core/timer.h"

namespace fsm {

/// Sends pictures of the face to another program, independently of films: docs/face.md, Pictures
/// for other programs. Picture k shows the face at start + k / rate. Pictures are skipped if the
/// machine or the receiver is too slow, or if they would look like the one before, but at least one
/// per kStillLimit is sent. Thread: the scheduler's; a timer is pending while there is a receiver.
class PictureStream {
 public:
  static constexpr vm::Time kStillLimit{500'000};

  using Draw = std::function<vm::Result<void>(vm::Time at)>;
  /// Tells whether the face may look different at `to` than at `from`.
  using Moves = std::function<bool(vm::Time from, vm::Time to)>;
  using OnFailure = std::function<void(const vm::Error&)>;
  PictureStream(vm::Scheduler& clock, FaceView& view, Draw draw, Moves moves, OnFailure on_failure);

  /// Closes the current connection and connects to `to`: "unix:PATH" of a listening socket, or
  /// "NONE".
  /// Errors: kBadValue, kUnavailable; there is then no receiver.
  vm::Result<void> SendTo(const std::string& to, int per_second);
  /// Returns the argument of SendTo; "NONE" once the receiver has closed.
  std::string to();
  /// Says that the face may look different after a command.
  void Touch() { touched_ = true; }

 private:
  void Tick();
  /// Returns false after an error, which has been reported.
  bool DrawAndSend(vm::Time at);
  void Disconnect();

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
