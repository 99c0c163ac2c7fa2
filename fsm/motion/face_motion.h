#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "fsm/motion/expression/blend_shape_motion.h"
#include "fsm/motion/expression/expression_motion.h"
#include "fsm/motion/expression/mood_motion.h"
#include "fsm/motion/expression/unit_motion.h"
#include "fsm/motion/eye_motion.h"
#include "fsm/motion/head_motion.h"
#include "fsm/motion/idle_behaviour.h"
#include "fsm/motion/inputs/motion_inputs.h"
#include "fsm/motion/mouth_motion.h"
#include "fsm/motion/speech/mouth_stream.h"
#include "fsm/motion/speech/speech_motion.h"
#include "fsm/rig/face_state.h"
#include "vm_protocol/core/result.h"
#include "vm_protocol/core/scheduler.h"

namespace fsm {

/// The motion of the face: takes commands, each with its time, and returns the state of the face at
/// any instant from the last command on, and of the head, which springs follow, from
/// Track::kMemory before it. Pure in time: the same commands at the same times give the
/// same states, however often and in whatever order states are asked for. Each kind of movement is
/// a MotionSource with its own commands; tables/mixing.txt defines how Mixer combines them.
/// Errors: kBadValue for names and patterns that the tables do not have (the text lists what
/// exists), and for strengths that are not numbers or are out of range. Thread: one at a time,
/// const calls included.
class FaceMotion {
  MotionInputs inputs_;  // comes first: all sources refer to it

 public:
  FaceMotion(MotionTables tables, std::uint64_t seed) : inputs_(std::move(tables), seed) {}
  FaceMotion(const FaceMotion&) = delete;
  FaceMotion& operator=(const FaceMotion&) = delete;

  // The built-in sources, each with its own commands. None refers to another.
  IdleBehaviour idle{inputs_};
  ExpressionMotion expression{inputs_};
  UnitMotion action_units{inputs_.tables.unit_names};
  MouthMotion mouth;
  BlendShapeMotion blend_shapes{inputs_.tables.blend_shapes};
  EyeMotion eyes{inputs_};
  HeadMotion head{inputs_.tables.motions};
  SpeechMotion speech{inputs_};
  MoodMotion mood{inputs_.tables.motions};
  MouthStream mouth_stream{inputs_};

  /// Adds a source of movement; see docs/extending.md.
  void Add(std::unique_ptr<MotionSource> source) {
    sources_.push_back(source.get());
    added_.push_back(std::move(source));
  }

  // Commands for more than one source.

  /// Sets Face.N; see FaceSlot for `position`. `strength`: 0..2, 1 = full.
  vm::Result<void> SetListedUnit(vm::Time now, int position, double strength);
  /// Plays a movement of the slot FaceMot `count` times (1..20). SHAKE is another name for REFUSE,
  /// TILT for LISTEN.
  vm::Result<void> PlayMovement(vm::Time now, std::string_view kind, int pattern,
                                double strength = 1, int count = 1);
  void StopMovements(vm::Time now);  ///< FaceMot = NOMOVE

  /// The expressions that can be shown.
  ExpressionStore& expressions() { return inputs_.expressions; }
  // Visemes; a change applies from the next utterance on.
  const Visemes& visemes(VisemeSetId set) const { return inputs_.tables.set(set).visemes; }
  /// Replaces the poses and hold times of a set; dominances and contacts are kept. REQUIRES: the
  /// same names in the same order.
  void SetVisemes(VisemeSetId set, Visemes visemes);

  // Settings. Those of speech apply at once, without a jump.
  const MotionSettings& settings() const { return inputs_.settings; }
  void Apply(vm::Time now, const MotionSettings& settings);
  // These two change at once, without a movement.
  Figure figure;
  float asymmetry = 1;  ///< FaceState::asymmetry
  /// Says what the face does by itself.
  IdleSwitches& switches() { return inputs_.switches; }

  FaceState StateAt(vm::Time t) const;

  /// Returns `t` while anything moves, else when a movement will begin by itself; none: the face is
  /// still until the next command.
  std::optional<vm::Time> NextMotion(vm::Time t) const;
  /// Returns when the onsets begun by `t` (expressions, units, eyes, head) will be complete.
  vm::Time SettledAt(vm::Time t) const;
  /// Returns when everything that has an end (expressions and turns with a duration, movements,
  /// blinks) will be over.
  vm::Time EndsAt(vm::Time t) const;

  const MotionTables& tables() const { return inputs_.tables; }

 private:
  std::vector<const MotionSource*> sources_{&idle,         &expression,  &action_units, &mouth,
                                            &blend_shapes, &eyes,        &head,         &speech,
                                            &mood,         &mouth_stream};
  std::vector<std::unique_ptr<MotionSource>> added_;
};

/// Returns the state of a face at rest when all that `command` begins at the time 0 has settled.
FaceState SettledAfter(const MotionTables& tables, const std::function<void(FaceMotion&)>& command);

}  // namespace fsm
