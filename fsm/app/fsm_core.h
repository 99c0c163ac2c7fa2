#pragma once

#include <functional>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "fsm/app/face_library.h"
#include "fsm/app/face_view.h"
#include "fsm/app/media_files.h"
#include "fsm/base/log.h"
#include "fsm/motion/face_motion.h"
#include "vm_protocol/core/scheduler.h"
#include "vm_protocol/core/slot_machine.h"
#include "vm_protocol/core/start_time.h"

namespace fsm {

/// Slots that belong together, with a state of their own and what the module does by itself after
/// their commands. A group is told what concerns it.
class SlotGroup {
 public:
  virtual ~SlotGroup() = default;
  /// Stops what is under way, such as films. Called for `Run = INIT`, before the motion is
  /// replaced, and at the end of the module.
  virtual void StopActivity() {}
  /// Restores the initial state. Called for `Run = INIT`, after the motion has been replaced and
  /// all slots have their initial values.
  virtual void RestoreInitial() {}
  /// Called after every command, because the face may now move or look different.
  virtual void OnChange() {}
  /// Called when an utterance has begun at `start`, now or just before.
  virtual void OnSpeechBegin(vm::Time /*start*/) {}
  /// Called when the utterance is over, but not by `Run = INIT`.
  virtual void OnSpeechEnd() {}
  /// Called when frame `number` of a film was drawn, which shows the face at `at`.
  virtual void OnFilmFrame(long /*number*/, vm::Time /*at*/) {}
  /// Tells whether it is at work on a command.
  virtual bool Busy() const { return false; }
};

/// What differs for clients of the original, whose configuration was given; the default is ours.
struct Conventions {
  float tilt = 1;                     ///< times z+ of an angle leans to the viewer's right
  Scene scene{};                      ///< at the start and after `Run = INIT`
  bool lists_our_backgrounds = true;  ///< beside those of a configuration
  static Conventions OfOriginal();
};

/// The state that the slot_groups of the face module share. Slots are declared by slots.Declare;
/// Command, CommandLater, Clamped and Setting make their actions. Lifetime: owned by FsmModule,
/// outlives the slot_groups.
struct FsmCore {
  vm::Scheduler& clock;
  FaceView& view;
  FaceLibrary& faces;
  MediaFiles files;
  Log log;
  Conventions conventions{};
  vm::SlotMachine slots{"FSM"};
  std::unique_ptr<FaceMotion> motion{};
  Scene scene{};
  bool simulates = true;  ///< whether springs move
  /// Called after every command, by all that Command and the like below make.
  std::function<void()> notify_changed = [] {};
  std::vector<std::unique_ptr<SlotGroup>> slot_groups{};

  vm::Time Now() const { return clock.Now(); }

  /// Draws the face at `t`.
  vm::Result<void> DrawAt(vm::Time t);
  /// Draws the face at `t` as frame `number` of a film.
  vm::Result<void> DrawFrame(long number, vm::Time t);

  /// Makes a group of slots of this core with the arguments `with`, and returns it.
  template <typename Made, typename... With>
  Made& Add(With&&... with) {
    auto group = std::make_unique<Made>(*this, std::forward<With>(with)...);
    Made& made = *group;
    slot_groups.push_back(std::move(group));
    return made;
  }

  /// SlotSpec::on_set.
  using OnSet = std::function<vm::Result<std::string>(const vm::SetValue&)>;
  /// SlotSpec::on_set_later.
  using OnSetLater = std::function<void(const vm::SetValue&, vm::Reply)>;
  /// Makes an on_set that executes `act(value)`, which returns what is stored (nothing or
  /// vm::Result<void>: the value unchanged), or its error.
  template <typename Act>
  OnSet Command(Act act) {
    return [this, act](const vm::SetValue& value) -> vm::Result<std::string> {
      auto done = ResultOf(act, value);
      notify_changed();
      if constexpr (std::is_same_v<decltype(done), vm::Result<std::string>>) {
        return done;
      } else {
        if (!done) return std::unexpected(done.error());
        return value.text;
      }
    };
  }
  /// Makes an on_set_later: the same, but what `act` returns is answered and not stored.
  template <typename Act>
  OnSetLater CommandLater(Act act) {
    return [command = Command(act)](const vm::SetValue& value, const vm::Reply& reply) {
      const auto done = command(value);
      done ? reply.Ok(*done) : reply.Fail(done.error());
    };
  }
  /// As Command, but clamps numbers to min..max first, as the original does.
  template <typename Act>
  OnSet Clamped(int min, int max, Act act) {
    return [min, max, command = Command(act)](vm::SetValue value) {
      ClampNumbers(value, min, max);
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
  /// Makes an action for a timer that concludes a command.
  template <typename Act>
  std::function<void()> Timed(Act act) {
    return [this, act] {
      act();
      notify_changed();
    };
  }

  vm::Time InstantOf(const vm::StartTime& start) const {
    return vm::Resolve(start, Now(), vm::WallSinceMidnight());
  }

 private:
  static void ClampNumbers(vm::SetValue& value, int min, int max);
  /// Returns the result of a function, which may be none.
  template <typename Function, typename... Arguments>
  static auto ResultOf(const Function& function, Arguments&&... arguments) {
    if constexpr (std::is_void_v<std::invoke_result_t<const Function&, Arguments...>>) {
      function(arguments...);
      return vm::Result<void>{};
    } else {
      return function(arguments...);
    }
  }
};

}  // namespace fsm
