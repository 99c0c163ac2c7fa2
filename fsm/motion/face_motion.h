#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "fsm/motion/expression_motion.h"
#include "fsm/motion/eye_motion.h"
#include "fsm/motion/head_motion.h"
#include "fsm/motion/idle_behaviour.h"
#include "fsm/motion/motion_tables.h"
#include "fsm/motion/person.h"
#include "fsm/motion/speech_motion.h"
#include "fsm/rig/face_state.h"
#include "vm_protocol/core/phonemes.h"
#include "vm_protocol/core/result.h"
#include "vm_protocol/core/scheduler.h"

namespace fsm {

/// How expressions come about: as measured on people, shown or felt, or in a fixed time.
enum class Onset { kPosed, kElicited, kFixed };

/// Times of movements which the original keeps in its configuration, and settings of speech.
struct MotionSettings {
  Onset onset = Onset::kPosed;
  vm::Time expression = std::chrono::milliseconds(100);  ///< EXPRESSION_DURATION, of kFixed
  vm::Time eye_move = std::chrono::milliseconds(70);     ///< EYEMOVE_DURATION
  double lead_ms = 40;                                   ///< the mouth is ahead of the voice
  double offset_ms = 0;                                  ///< delays the mouth
  double sync_offset_ms = 0;                             ///< added to what the voice reports
  double sync_rate = 0.25;  ///< how fast a difference is worked off, ms a ms
  /// The original's unit for the size of mouth movements; kFullMouthScale gives the full
  /// articulation of the shape table, the default 30 the three quarters of natural speech.
  double mouth_scale = 30;
  double gaze_distance_mm = 700;  ///< of what the eyes look at; 0 = far, the eyes are parallel
  LipStyle lips;
};
inline constexpr double kFullMouthScale = 40;

/// The face in time: takes commands with the instant they are given, and yields the state of the
/// face at any instant from the last command on. Pure in time: the same commands with the same
/// times give the same states, on any clock, however often and in whatever order it is asked.
/// Speech owns the mouth, so the emotions' mouth units count 0.4 while it speaks; brows and lids
/// stay whole. Head directions, movements and autonomous movement add up. The eyes stay on what
/// they look at while the head moves by itself or with the speech.
/// Errors: kBadValue with what there is, for names and patterns the tables do not have, and for
/// strengths that are no numbers or out of range. Thread: none of its own.
class FaceMotion {
 public:
  FaceMotion(MotionTables tables, std::uint64_t seed);
  FaceMotion(const FaceMotion&) = delete;  // parts refer to the tables

  // Expressions. Strength 1 is full, up to 2. A duration of zero holds until the next.
  vm::Result<void> Express(vm::Time now, std::string_view name, int pattern, double strength,
                           vm::Time duration);
  void Neutral(vm::Time now);
  /// Makes or changes one pattern of an expression; a new expression begins with pattern 1, a new
  /// pattern is the next. The name: letters, digits and _.
  vm::Result<void> DefineExpression(std::string_view name, int pattern, std::string_view look);
  /// Back to what the tables say: a changed expression is what it was, an own one is gone.
  void ForgetExpression(std::string_view name);

  // Units. A strength of 1 is full, up to 2.
  vm::Result<void> SetFace(vm::Time now, int position, double strength);    ///< Face.N
  vm::Result<void> SetMouth(vm::Time now, int parameter, double strength);  ///< Mouth.N, from 1
  /// One unit, `12L`, and one text of several, see ParseUnitCommand; codes of head and eyes too.
  vm::Result<void> SetUnit(vm::Time now, std::string_view unit, double strength, vm::Time move);
  vm::Result<void> SetUnits(vm::Time now, std::string_view text);
  vm::Result<void> CheckBlendShape(std::string_view name) const;
  vm::Result<void> SetBlendShape(vm::Time now, std::string_view name, double weight, vm::Time move);

  // Eyes and head. Degrees; x+ = down, y+ = to the viewer's right, z+ = tilt to the viewer's right.
  void TurnEyes(vm::Time now, bool left, bool right, double x, double y, vm::Time duration);
  void Gaze(vm::Time now, double x, double y, vm::Time duration);
  void LookAtUser(vm::Time now);  ///< and keeps looking there while the head turns
  void Think(vm::Time now);       ///< looks away, here and there, until the next Gaze
  void TurnHead(vm::Time now, const Angles& angles);
  void TurnHeadBy(vm::Time now, const Angles& angles);
  Angles HeadTarget(vm::Time now) const { return head_.TargetAt(now); }
  /// FaceMot: SHAKE is another name for REFUSE, TILT for LISTEN. `count` times (1..20).
  vm::Result<void> Move(vm::Time now, std::string_view kind, int pattern, double strength = 1,
                        int count = 1);
  void StopMoves(vm::Time now);  ///< FaceMot = NOMOVE
  vm::Result<void> Autonomous(vm::Time now, std::string_view kind, int pattern);
  /// A profile of the table, or OFF: everything as it is at the start.
  vm::Result<void> SetIdle(vm::Time now, std::string_view profile);
  /// Whose face it is: which side of it is first.
  void SetPerson(std::uint64_t person);

  // Speech.
  void Speak(vm::Time now, const vm::PhonemeList& phonemes, vm::Time start);
  void StopSpeaking(vm::Time now);
  void Sync(vm::Time now, double voice_ms);
  bool speaking() const { return speech_.active(); }
  std::optional<vm::Time> SpeechEnd() const { return speech_.End(); }
  double VoicePosition(vm::Time t) const { return speech_.VoicePositionAt(t); }
  const std::string& PhonemeAt(vm::Time t) const { return speech_.PhonemeAt(t); }
  /// Phonemes no table has, once each: the mouth closes on them.
  std::vector<std::string> UnknownPhonemes(const vm::PhonemeList& phonemes) const;

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
  static constexpr float kEmotionWhileSpeaking = 0.4f;
  using Tracks = std::array<Track<float>, kActionUnits>;

  void SetOne(vm::Time now, const UnitSetting& unit, vm::Time move);
  void LookSomewhere(vm::Time now, bool user, bool think);
  void BlinkAtShift(vm::Time now, const EyeAngles& from, const EyeAngles& to);
  vm::Time OnsetOf(const Emotion& emotion) const;
  const AutoAvert* Avert() const;  // nullptr while it is off

  // Parts of StateAt.
  ActionUnits UnitsAt(vm::Time t, const SpeechMotion::Mouth& speech,
                      const SpeechMotion::Gesture& gesture) const;
  void PlaceMouth(vm::Time t, const SpeechMotion::Mouth& speech, FaceState& state) const;
  void PlaceHeadAndEyes(vm::Time t, const SpeechMotion::Mouth& speech,
                        const SpeechMotion::Gesture& gesture, const ActionUnits& units,
                        FaceState& state) const;
  double LidsShutAt(vm::Time t) const;
  /// Calls `visit` with every plain track (units, codes, mouth, emotions, shapes, gaze).
  template <typename Visit>
  void ForEachTrack(const Visit& visit) const;

  MotionTables tables_;
  const EmotionTable table_emotions_;  // as they were at the start
  MotionSettings settings_;
  FaceState figure_;
  std::uint64_t seed_;
  ExpressionMotion::Sides side_lags_;
  ExpressionMotion expression_;
  HeadMotion head_;
  EyeMotion eyes_;
  IdleBehaviour idle_;
  SpeechMotion speech_;
  std::int64_t utterances_ = 0;
  std::int64_t shifts_ = 0;  // of the gaze
  Track<float> mouth_scale_{30.0f};
  Tracks units_left_, units_right_;
  std::map<int, Track<float>> codes_;  // those ever set
  std::array<Track<float>, kMouthParameters> mouth_;
  std::vector<Track<float>> emotions_;                             // Face.31 and on, by position
  std::map<std::string, Track<float>, std::less<>> blend_shapes_;  // those ever set
  Track<float> on_user_, thinking_, vergence_deg_;
  vm::Time thinking_since_{0};
};

}  // namespace fsm
