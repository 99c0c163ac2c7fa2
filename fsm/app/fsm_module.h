#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "fsm/app/frame_loop.h"
#include "fsm/app/frame_slots.h"
#include "fsm/app/fsm_core.h"
#include "fsm/app/record_slots.h"
#include "fsm/base/log.h"
#include "fsm/base/table_folder.h"
#include "fsm/faces/original_config.h"
#include "vm_protocol/core/module.h"

namespace fsm {

struct FsmOptions {
  std::uint64_t seed = 1;    ///< of all idle and random behaviour
  TableFolder tables;        ///< replace those of the program
  std::string initial_face;  ///< "" = the library's first
  std::string background;  ///< initial value of the slot Background, "" = the configuration's first
  std::string life = "OFF";             ///< initial profile of the slot Life
  OriginalConfig config;                ///< none if its path is ""; else reported in the greeting
  Log log = [](const std::string&) {};  ///< takes lines for people
  /// Called when drawing in the window fails, which ends the module.
  std::function<void()> on_failure = [] {};
};

/// The face synthesis module: all slots, which control FaceMotion, a view and a library.
/// Drawing: with a window, at the frame rate while something moves and a few times a second
/// otherwise; without one, only for pictures, films and Frame reports. Without a window no timer is
/// pending while nothing moves and nothing is recorded or sent.
/// Lifetime: scheduler, view and library outlive it. Thread: the scheduler's.
class FsmModule final : public vm::Module {
 public:
  /// Throws std::runtime_error if tables or configuration are damaged.
  FsmModule(vm::Scheduler& clock, FaceView& view, FaceLibrary& library, MediaFiles files,
            FsmOptions options);

  vm::SlotMachine& slots() override { return core_.slots; }
  std::vector<vm::Message> Greeting() override;
  bool Busy() const override;
  bool ExitRequested() const override { return exit_requested_; }
  void Shutdown() override;
  const FaceMotion& motion() const { return *core_.motion; }

 private:
  void ApplyConfig(const OriginalConfig& config);
  void MakeMotion();
  void Initialise();  // Run = INIT
  void Changed();
  void MakeFrameLoop(const RecordSlots& record, FrameSlots& frames);
  /// Returns false if drawing fails, which ends the module.
  bool DrawInWindow(vm::Time now);

  FsmOptions options_;
  MotionTables tables_;
  MotionSettings start_settings_;
  FsmCore core_;
  double frame_rate_ = 60;               // of a window
  std::optional<FrameLoop> frame_loop_;  // refers to slot_groups of core_
  bool exit_requested_ = false;
};

}  // namespace fsm
