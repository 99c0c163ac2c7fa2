#pragma once

#include <functional>
#include <memory>
#include <string>

#include "face_track/live/face_command.h"
#include "face_track/live/live_tracker.h"
#include "face_track/print/face_print.h"
#include "vm_protocol/core/module.h"

namespace facetrack {

/// The module that moves the agent as a person before a camera moves (TRACK):
///
///   OFF --Run = START--> LOOKING --a face--> FOLLOWING --lost--> LOOKING
///
/// To the face: `to @FSM set AU = ...` for each picture. Thread: the scheduler's.
class TrackModule final : public vm::Module {
 public:
  struct Options {
    std::string module_version{};
    Tracker::Settings tracker{};
    /// Begins to follow a face in a source by name. Errors: as OpenPictures', and no networks.
    std::function<vm::Result<std::unique_ptr<LiveTracker>>(
        const std::string& name, const Tracker::Settings& settings, LiveTracker::Events events)>
        open{};
  };
  /// So long after the last face the agent goes back to rest.
  static constexpr vm::Time kHome{1'000'000};

  TrackModule(vm::Scheduler& scheduler, Options options);
  ~TrackModule() override { Shutdown(); }

  vm::SlotMachine& slots() override { return slots_; }
  bool Busy() const override { return false; }
  bool ExitRequested() const override { return exit_requested_; }
  void Shutdown() override;

 private:
  void DeclareRun();
  void DeclareSettings();
  void DeclareTold();
  vm::Result<void> Start();
  void Stop();
  void OnMoment(const LiveTracker::Moment& moment);
  void Show(const FaceLine& line);
  void GoHome();
  void TellFace(const std::string& units);
  void Tell(const std::string& stat);

  vm::Scheduler& scheduler_;
  Options options_;
  vm::SlotMachine slots_;
  const FacePrint print_;
  FaceCommand command_;
  std::string input_ = "NONE", face_ = "FSM", stat_ = "OFF";
  bool on_ = false, mirrored_ = true, exit_requested_ = false;
  std::unique_ptr<LiveTracker> tracker_;
  double last_ms_ = 0;  // of the line shown last
  vm::TimerId home_timer_ = 0;
  // Of the second that is being counted.
  vm::Time second_{0};
  int pictures_ = 0;
  std::chrono::microseconds taken_{};
};

}  // namespace facetrack
