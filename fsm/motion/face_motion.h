#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
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
#include "vm_protocol/core/phonemes.h"
#include "vm_protocol/core/result.h"
#include "vm_protocol/core/scheduler.h"

namespace fsm {

/// The face in time: takes commands with the instant they are given, and yields the state of the
/// face at any instant from the last command on. Pure in time: the same commands with the same
/// times give the same states, on any clock, however often and in whatever order it is asked.
/// Each kind of movement is a MotionSource; tables/mixing.txt says how they become one face.
/// Errors: kBadValue with what there is, for names and patterns the tables do not have, and for
/// strengths that are no numbers or out of range. Thread: none of its own; not even const calls may
/// run at once.
class FaceMotion {
 public:
  FaceMotion(MotionTables tables, std::uint64_t seed) : tables_(std::move(tables)), seed_(seed) {}
  FaceMotion(const FaceMotion&) = delete;  // sources refer to the tables

  /// Another source of movement, mixed with those there are; see docs/extending.md.
  void Add(std::unique_ptr<MotionSource> source) { sources_.push_back(std::move(source)); }

  // Expressions. Strength 1 is full, up to 2. A duration of zero holds until the next.
  vm::Result<void> Express(vm::Time now, std::string_view name, int pattern, double strength,
                           vm::Time duration) {
    return expression_.Show(now, name, pattern, strength, duration);
  }
  void Neutral(vm::Time now) { expression_.Neutral(now); }
  /// A slight look beneath expressions: one of the table's, or NEUTRAL.
  vm::Result<void> SetMood(vm::Time now, std::string_view name, double strength) {
    return mood_.Set(now, name, strength);
  }
  /// Makes or changes one pattern of an expression; a new expression begins with pattern 1, a new
  /// pattern is the next. The name: letters, digits and _.
  vm::Result<void> DefineExpression(std::string_view name, int pattern, std::string_view look) {
    return expression_.Define(name, pattern, look);
  }
  /// Back to what the tables say: a changed expression is what it was, an own one is gone.
  void ForgetExpression(std::string_view name) { expression_.Forget(name); }

  // Units. A strength of 1 is full, up to 2.
  vm::Result<void> SetFace(vm::Time now, int position, double strength);  ///< Face.N
  /// Mouth.N, from 1.
  vm::Result<void> SetMouth(vm::Time now, int parameter, double strength) {
    return mouth_.Set(now, parameter, strength);
  }
  /// One unit, `12L`, and one text of several, see ParseUnitCommand; codes of head and eyes too.
  vm::Result<void> SetUnit(vm::Time now, std::string_view unit, double strength, vm::Time move) {
    return units_.Set(now, unit, strength, move);
  }
  vm::Result<void> SetUnits(vm::Time now, std::string_view text) { return units_.Set(now, text); }
  vm::Result<void> CheckBlendShape(std::string_view name) const { return shapes_.Check(name); }
  vm::Result<void> SetBlendShape(vm::Time now, std::string_view name, double weight,
                                 vm::Time move) {
    return shapes_.Set(now, name, weight, move);
  }

  // Eyes and head. Degrees; x+ = down, y+ = to the viewer's right, z+ = tilt to the viewer's right.
  void TurnEyes(vm::Time now, bool left, bool right, double x, double y, vm::Time duration) {
    eyes_.Turn(now, left, right, {static_cast<float>(x), static_cast<float>(y)}, duration);
  }
  void Gaze(vm::Time now, double x, double y, vm::Time duration) {
    eyes_.Gaze(now, {static_cast<float>(x), static_cast<float>(y)}, duration);
  }
  void LookAtUser(vm::Time now) { eyes_.LookAtUser(now); }  ///< also while the head turns
  void Think(vm::Time now) { eyes_.Think(now); }  ///< looks away, here and there, until the next
  void TurnHead(vm::Time now, const Angles& angles) { head_.TurnTo(now, angles); }
  void TurnHeadBy(vm::Time now, const Angles& angles) { head_.TurnBy(now, angles); }
  /// FaceMot: SHAKE is another name for REFUSE, TILT for LISTEN. `count` times (1..20).
  vm::Result<void> Move(vm::Time now, std::string_view kind, int pattern, double strength = 1,
                        int count = 1);
  void StopMoves(vm::Time now);  ///< FaceMot = NOMOVE
  vm::Result<void> Autonomous(vm::Time now, std::string_view kind, int pattern) {
    return idle_.Set(now, kind, pattern);
  }
  /// A profile of the table, or OFF: everything as it is at the start.
  vm::Result<void> SetIdle(vm::Time now, std::string_view profile) {
    return idle_.SetProfile(now, profile);
  }
  /// Whose face it is: which side of it is first.
  void SetPerson(std::uint64_t person);

  // Speech.
  /// `text`: what is said, if it is known: it gives sentences slight looks.
  void Speak(vm::Time now, const vm::PhonemeList& phonemes, vm::Time start,
             std::string_view text = {}) {
    speech_.Start(now, phonemes, start, text);
  }
  void StopSpeaking(vm::Time now) { speech_.Stop(now); }
  void Sync(vm::Time now, double voice_ms) { speech_.Sync(now, voice_ms); }
  bool speaking() const { return speech_.active(); }
  std::optional<vm::Time> SpeechEnd() const { return speech_.End(); }
  double VoicePosition(vm::Time t) const { return speech_.VoicePositionAt(t); }
  const std::string& PhonemeAt(vm::Time t) const { return speech_.PhonemeAt(t); }
  /// Phonemes no table has, once each: the mouth closes on them.
  std::vector<std::string> UnknownPhonemes(const vm::PhonemeList& phonemes) const {
    return MakeVisemeTargets(phonemes, tables_, settings_.lips).unknown;
  }

  // The mouth frame by frame, from another program, with head and brows if it says them.
  vm::Result<void> AddMouthFrame(vm::Time now, vm::Time at, const MouthPose& pose,
                                 const std::optional<StreamHead>& head = std::nullopt) {
    return mouth_stream_.Add(now, at, pose, head);
  }
  void StopMouthFrames(vm::Time now) { mouth_stream_.Stop(now); }
  /// The instant from which those who give frames count their times; 0 at first.
  vm::Time mouth_frames_start() const { return mouth_frames_start_; }
  void set_mouth_frames_start(vm::Time start) { mouth_frames_start_ = start; }

  // Mouth shapes, from the next utterance on. `bilingual`: of the 28, else of the 14.
  const Visemes& shapes(bool bilingual) const {
    return bilingual ? tables_.set28.shapes : tables_.set14.shapes;
  }
  /// REQUIRES: the same names in the same order. How they dominate each other is kept.
  void SetShapes(bool bilingual, Visemes shapes);

  // Settings. Those of speech act at once, without a jump.
  const MotionSettings& settings() const { return settings_; }
  void Apply(vm::Time now, const MotionSettings& settings);

  // The whole figure, moved at once. (The state's other fields are ignored.)
  FaceState& figure() { return figure_; }

  FaceState StateAt(vm::Time t) const;

  /// `t` while anything moves, else when something will begin by itself; none = all is still.
  std::optional<vm::Time> NextActivity(vm::Time t) const;
  /// When the onsets begun by `t` (expressions, units, eyes, head) will have settled.
  vm::Time OnsetsSettled(vm::Time t) const;
  /// When everything with an end (timed expressions, movements, blinks, turns) will be over.
  vm::Time FiniteEnd(vm::Time t) const;

  const MotionTables& tables() const { return tables_; }

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
  FaceState figure_;
  std::uint64_t seed_;
  vm::Time mouth_frames_start_{0};
  std::vector<std::unique_ptr<MotionSource>> sources_;
  // The sources the face has from the start. They take what they need as references to the above.
  IdleBehaviour& idle_ = Make<IdleBehaviour>(tables_.motions, seed_);
  ExpressionMotion& expression_ = Make<ExpressionMotion>(tables_, settings_, idle_, seed_);
  UnitMotion& units_ = Make<UnitMotion>(tables_.unit_names);
  MouthMotion& mouth_ = Make<MouthMotion>();
  BlendShapeMotion& shapes_ = Make<BlendShapeMotion>(tables_.blend_shapes);
  EyeMotion& eyes_ = Make<EyeMotion>(tables_.motions, settings_, idle_, seed_);
  HeadMotion& head_ = Make<HeadMotion>(tables_.motions);
  SpeechMotion& speech_ = Make<SpeechMotion>(tables_, settings_, idle_, seed_);
  MoodMotion& mood_ = Make<MoodMotion>(tables_.motions);
  MouthStream& mouth_stream_ = Make<MouthStream>();
};

}  // namespace fsm
