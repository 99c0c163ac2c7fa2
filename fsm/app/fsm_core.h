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
#include "fsm/base/log.h"
#include "fsm/motion/face_motion.h"
#include "vm_protocol/core/scheduler.h"
#include "vm_protocol/core/slot_machine.h"
#include "vm_protocol/core/start_time.h"

namespace fsm {

/// A part of the module with a state of its own. It is told what concerns it.
class ModulePart {
 public:
  virtual ~ModulePart() = default;
  /// Ends activities such as films. Called for `Run = INIT`, before the motion is replaced, and at
  /// the end of the module.
  virtual void End() {}
  /// Restores the initial state. Called for `Run = INIT`, after the motion has been replaced and
  /// all slots have their initial values.
  virtual void Reset() {}
  /// Called after every command, because the face may now move or look different.
  virtual void OnChange() {}
  /// Called when an utterance has begun at `start`, now or just before.
  virtual void OnSpeechBegin(vm::Time /*start*/) {}
  /// Called when the utterance is over, but not by `Run = INIT`.
  virtual void OnSpeechEnd() {}
  /// Called when frame `number` of a film was drawn, which shows the face at `at`.
  virtual void OnFrame(long /*number*/, vm::Time /*at*/) {}
  /// Tells whether it is at work on a command.
  virtual bool Busy() const { return false; }
};

/// The state that the parts of the face module share. Slots are declared by slots.Declare; Command,
/// Clamped and Setting make their on_set.
/// Lifetime: owned by FsmModule, outlives the parts.
struct FsmCore {
  vm::Scheduler& clock;
  FaceView& view;
  Wardrobe& wardrobe;
  MediaFiles files;
  Log log;
  /// Whether a configuration of the original was given. Positions of the figure are then in halves
  /// of the view, and z+ leans to the viewer's left, as its clients expect.
  bool original = false;
  vm::SlotMachine slots{"FSM"};
  std::unique_ptr<FaceMotion> motion{};
  Scene scene{};
  bool simulates = true;  ///< whether springs move
  /// Called after every command.
  std::function<void()> changed = [] {};
  std::vector<std::unique_ptr<ModulePart>> parts{};

  vm::Time Now() const { return clock.Now(); }

  /// Draws the face at `t`.
  vm::Result<void> DrawAt(vm::Time t);
  /// Draws the face at `t` as frame `number` of a film.
  vm::Result<void> DrawFrame(long number, vm::Time t);

  /// Makes a part of this core with the arguments `with`, and returns it.
  template <typename Part, typename... With>
  Part& Add(With&&... with) {
    auto part = std::make_unique<Part>(*this, std::forward<With>(with)...);
    Part& made = *part;
    parts.push_back(std::move(part));
    return made;
  }

  /// SlotSpec::on_set.
  using OnSet = std::function<vm::Result<std::string>(const vm::SetValue&)>;
  /// Makes an on_set that executes `act(value)` and stores the value unchanged, or returns the
  /// error of `act`.
  template <typename Act>
  OnSet Command(Act act) {
    return [this, act](const vm::SetValue& value) -> vm::Result<std::string> {
      if (auto done = ResultOf(act, value); !done) return std::unexpected(done.error());
      changed();
      return value.text;
    };
  }
  /// The same, but clamps numbers to least..most first, as the original does.
  template <typename Act>
  OnSet Clamped(int least, int most, Act act) {
    return [least, most, command = Command(act)](vm::SetValue value) {
      ClampNumbers(value, least, most);
      return command(value);
    };
  }
  /// Makes an on_set that calls `change(settings, value)` and applies the settings, or returns its
  /// error.
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
  /// Returns the result of a function that returns vm::Result<void> or void.
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

}  // namespace fsm
