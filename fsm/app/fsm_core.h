#pragma once

#include <functional>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "fsm/app/face_view.h"
#include "fsm/app/media_files.h"
#include "fsm/app/wardrobe.h"
#include "fsm/motion/face_motion.h"
#include "vm_protocol/core/scheduler.h"
#include "vm_protocol/core/slot_machine.h"
#include "vm_protocol/core/start_time.h"

namespace fsm {

/// What the parts of the face module share. Lifetime: owned by FsmModule, outlives the parts.
struct FsmCore {
  vm::Scheduler& clock;
  FaceView& view;
  Wardrobe& wardrobe;
  MediaFiles files;
  /// A configuration of the original was given: its clients speak, so places of the figure count
  /// half views and z+ leans to the viewer's left, as there.
  bool original = false;
  vm::SlotMachine slots{"FSM"};
  std::unique_ptr<FaceMotion> motion{};
  Scene scene{};
  bool simulates = true;  ///< what hangs on springs swings
  /// Called after every command, because something may move now, or look different.
  std::function<void()> changed = [] {};
  /// Every slot declared with Declare, with its value at start, for `Run = INIT`.
  std::vector<std::pair<std::string, std::string>> initial_values{};
  std::size_t declared_at_start = 0;  ///< how many of them the module itself has

  vm::Time Now() const { return clock.Now(); }

  /// Draws the face as it is at `t`.
  vm::Result<void> DrawAt(vm::Time t);

  using Action = std::function<vm::Result<void>(const vm::SetValue&)>;
  struct Declaration {
    std::string name;
    std::string grammar;
    std::string help;
    Action action;
    std::string initial = "";
    bool readable = true;  ///< false: the slot is an action and has no value to ask for
    bool quoted = false;
    /// Numbers are clamped to least..most, as the original does, unless both are 0.
    int least = 0, most = 0;
    /// How the value is told; null: as it came.
    std::string (*told)(const vm::SetValue&) = nullptr;
  };
  /// A slot whose value is stored as it came if the action accepts it.
  void Declare(Declaration slot);

  /// The action of a slot that is a setting: `change(settings, value)` changes it or returns why
  /// not.
  template <typename Change>
  Action Setting(Change change) {
    return [this, change](const vm::SetValue& value) -> vm::Result<void> {
      MotionSettings settings = motion->settings();
      if constexpr (std::is_void_v<decltype(change(settings, value))>) {
        change(settings, value);
      } else if (auto done = change(settings, value); !done) {
        return done;
      }
      motion->Apply(Now(), settings);
      return {};
    };
  }

  vm::Time InstantOf(const vm::StartTime& start) const {
    return vm::Resolve(start, Now(), vm::WallSinceMidnight());
  }

  /// A slot that tells what the module knows, with SlotMachine::Report or Store.
  void DeclareReadOnly(std::string name, std::string initial, std::string help,
                       bool quoted = false);

  /// Takes back the slots declared after the module's own, for `Run = INIT`. Not from within one of
  /// their callbacks.
  void ForgetSlotsSinceStart();
};

}  // namespace fsm
