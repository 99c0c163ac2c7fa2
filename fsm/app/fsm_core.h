#pragma once

#include <functional>
#include <memory>
#include <string>
#include <type_traits>

#include "fsm/app/face_view.h"
#include "fsm/app/media_files.h"
#include "fsm/app/wardrobe.h"
#include "fsm/motion/face_motion.h"
#include "vm_protocol/core/scheduler.h"
#include "vm_protocol/core/slot_machine.h"
#include "vm_protocol/core/start_time.h"

namespace fsm {

/// What the parts of the face module share. Slots are declared with slots.Declare; Command, Clamped
/// and Setting make their on_set.
/// Lifetime: owned by FsmModule, outlives the parts.
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

  vm::Time Now() const { return clock.Now(); }

  /// Draws the face as it is at `t`.
  vm::Result<void> DrawAt(vm::Time t);

  /// SlotSpec::on_set.
  using OnSet = std::function<vm::Result<std::string>(const vm::SetValue&)>;
  /// Of a slot whose value is stored as it came: `act(value)` does what it asks for, or returns why
  /// not.
  template <typename Act>
  OnSet Command(Act act) {
    return [this, act](const vm::SetValue& value) -> vm::Result<std::string> {
      if (auto done = ResultOf(act, value); !done) return std::unexpected(done.error());
      changed();
      return value.text;
    };
  }
  /// The same with numbers clamped to least..most, as the original does.
  template <typename Act>
  OnSet Clamped(int least, int most, Act act) {
    return [least, most, command = Command(act)](vm::SetValue value) {
      ClampNumbers(value, least, most);
      return command(value);
    };
  }
  /// Of a slot that is a setting: `change(settings, value)` changes it, or returns why not.
  template <typename Change>
  OnSet Setting(Change change) {
    return Command([this, change](const vm::SetValue& value) {
      MotionSettings settings = motion->settings();
      auto done = ResultOf(change, settings, value);
      if (done) motion->Apply(Now(), settings);
      return done;
    });
  }

  vm::Time InstantOf(const vm::StartTime& start) const {
    return vm::Resolve(start, Now(), vm::WallSinceMidnight());
  }

 private:
  static void ClampNumbers(vm::SetValue& value, int least, int most);
  /// What a function says that returns a vm::Result<void>, or nothing.
  template <typename Function, typename... Arguments>
  static vm::Result<void> ResultOf(const Function& function, Arguments&&... arguments) {
    if constexpr (std::is_void_v<std::invoke_result_t<const Function&, Arguments...>>) {
      function(arguments...);
      return {};
    } else {
      return function(arguments...);
    }
  }
};

/// A part of the module that remembers something between two commands.
class ModulePart {
 public:
  virtual ~ModulePart() = default;
  /// Ends what goes on in time, as films do: for `Run = INIT`, while the face is as it was, and at
  /// the end of the module.
  virtual void End() {}
  /// Forgets what was said, for `Run = INIT`: the motion is new, and every slot has its initial
  /// value again.
  virtual void Reset() {}
};

}  // namespace fsm
