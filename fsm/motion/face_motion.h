#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "fsm/motion/blend_shape_motion.h"
#include "fsm/motion/expression_motion.h"
#include "fsm/motion/eye_motion.h"
#include "fsm/motion/head_motion.h"
#include "fsm/motion/idle_behaviour.h"
#include "fsm/motion/mood_motion.h"
#include "fsm/motion/motion_settings.h"
#include "fsm/motion/motion_tables.h"
#include "fsm/motion/mouth_motion.h"
#include "fsm/motion/mouth_stream.h"
#include "fsm/motion/speech_motion.h"
#include "fsm/motion/unit_motion.h"
#include "fsm/rig/face_state.h"
#include "vm_protocol/core/result.h"
#include "vm_protocol/core/scheduler.h"

namespace fsm {

/// The face in time: takes commands with the instant they are given, and yields the state of the
/// face at any instant from the last command on. Pure in time: the same commands with the same
/// times give the same states, on any clock, however often and in whatever order it is asked.
/// Each kind of movement is a MotionSource with commands of its own; tables/mixing.txt says how
/// they become one face.
/// Errors: kBadValue with what there is, for names and patterns the tables do not have, and for
/// strengths that are no numbers or out of range. Thread: none of its own; not even const calls may
/// run at once.
class FaceMotion {
 public:
  FaceMotion(MotionTables tables, std::uint64_t seed) : tables_(std::move(tables)), seed_(seed) {}
  FaceMotion(const FaceMotion&) = delete;  // sources refer to the tables

  /// Another source of movement, mixed with those there are; see docs/extending.md.
  void Add(std::unique_ptr<MotionSource> source) { sources_.push_back(std::move(source)); }

  // What concerns more than one source.

  /// Face.N. A strength of 1 is full, up to 2.
  vm::Result<void> SetFace(vm::Time now, int position, double strength);
  /// FaceMot: SHAKE is another name for REFUSE, TILT for LISTEN. `count` times (1..20).
  vm::Result<void> Move(vm::Time now, std::string_view kind, int pattern, double strength = 1,
                        int count = 1);
  void StopMoves(vm::Time now);  ///< FaceMot = NOMOVE

  // Visemes, from the next utterance on.
  const Visemes& visemes(VisemeSetId set) const { return tables_.set(set).visemes; }
  /// REQUIRES: the same names in the same order. How they dominate each other is kept.
  void SetVisemes(VisemeSetId set, Visemes visemes);

  // Settings. Those of speech act at once, without a jump.
  const MotionSettings& settings() const { return settings_; }
  void Apply(vm::Time now, const MotionSettings& settings);

  FaceState StateAt(vm::Time t) const;

  /// `t` while anything moves, else when something will begin by itself; none = all is still.
  std::optional<vm::Time> NextActivity(vm::Time t) const;
  /// When the onsets begun by `t` (expressions, units, eyes, head) will have settled.
  vm::Time OnsetsSettled(vm::Time t) const;
  /// When everything with an end (timed expressions, movements, blinks, turns) will be over.
  vm::Time FiniteEnd(vm::Time t) const;

  const MotionTables& tables() const { return tables_; }

  // What does not move but is there at once.
  Figure figure;
  float asymmetry = 1;  ///< FaceState::asymmetry

 private:
  template <typename Source, typename... With>
  Source& Make(With&&... with) {
    auto source = std::make_unique<Source>(std::forward<With>(with)...);
    Source& made = *source;
    Add(std::move(source));
    return made;
  }

  MotionTables tables_;
  MotionSettings settings_;
  std::uint64_t seed_;
  std::vector<std::unique_ptr<MotionSource>> sources_;

 public:
  // The sources the face has from the start. They take what they need as references to the above.
  IdleBehaviour& idle = Make<IdleBehaviour>(tables_.motions, tables_.gestures, seed_);
  ExpressionMotion& expression = Make<ExpressionMotion>(tables_, settings_, idle, seed_);
  UnitMotion& units = Make<UnitMotion>(tables_.unit_names);
  MouthMotion& mouth = Make<MouthMotion>();
  BlendShapeMotion& blend_shapes = Make<BlendShapeMotion>(tables_.blend_shapes);
  EyeMotion& eyes = Make<EyeMotion>(tables_.motions, tables_.gestures, settings_, idle, seed_);
  HeadMotion& head = Make<HeadMotion>(tables_.motions);
  SpeechMotion& speech = Make<SpeechMotion>(tables_, settings_, idle, seed_);
  MoodMotion& mood = Make<MoodMotion>(tables_.motions);
  MouthStream& mouth_stream = Make<MouthStream>();
};

}  // namespace fsm
