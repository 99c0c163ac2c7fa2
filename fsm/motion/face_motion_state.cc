// What FaceMotion's face looks like at an instant.

#include <algorithm>

#include "fsm/motion/face_motion.h"
#include "fsm/motion/random.h"

namespace fsm {
namespace {

using namespace std::chrono_literals;
enum Stream : std::uint64_t { kEndBlink = 310, kEndBlinkTime, kAvertBlink };

constexpr std::size_t kNostrils = 38;  // the unit that opens them

}  // namespace

const AutoAvert* FaceMotion::Avert() const {
  const std::size_t pattern = idle_.Pattern(IdleKind::kAvert);
  return pattern == 0 ? nullptr : &tables_.motions.auto_averts[pattern - 1];
}

ActionUnits FaceMotion::UnitsAt(vm::Time t, const SpeechMotion::Mouth& speech,
                                const SpeechMotion::Gesture& gesture) const {
  const double mouth_share = 1 - (1 - kEmotionWhileSpeaking) * speech.over_emotion;
  ActionUnits units = expression_.At(t, tables_.units, mouth_share);

  const auto add_look = [&](const ActionUnits& pattern, double weight) {
    ActionUnits look;
    AddTo(look, pattern, weight);
    for (std::size_t unit = 0; unit < kActionUnits; ++unit) {
      if (tables_.units.region[unit] != Region::kMouth) continue;
      look.left[unit] = static_cast<float>(look.left[unit] * mouth_share);
      look.right[unit] = static_cast<float>(look.right[unit] * mouth_share);
    }
    AddTo(units, look, 1);
  };
  for (std::size_t i = 0; i < emotions_.size(); ++i) {
    const float weight = emotions_[i].At(t);
    const auto found = tables_.emotions.find(tables_.units.emotions[i]);
    if (weight == 0 || found == tables_.emotions.end()) continue;
    add_look(found->second.patterns[0], weight);
  }
  if (const std::size_t face = idle_.Pattern(IdleKind::kFace); face > 0) {
    add_look(tables_.motions.auto_faces[face - 1], idle_.Weight(IdleKind::kFace, t));
  }
  for (const auto& [name, track] : blend_shapes_) {
    AddTo(units, tables_.blend_shapes.find(name)->second, track.At(t));
  }
  if (const std::size_t pattern = idle_.Pattern(IdleKind::kSpeech); pattern > 0) {
    const double brow = idle_.Weight(IdleKind::kSpeech, t) * gesture.head.brow *
                        tables_.motions.auto_speeches[pattern - 1].brow;
    for (auto* side : {&units.left, &units.right}) {
      (*side)[1] += static_cast<float>(brow);
      (*side)[2] += static_cast<float>(0.8 * brow);
    }
  }
  const auto breath = static_cast<float>(0.15 * idle_.BreathAt(t));
  units.left[kNostrils] += breath;
  units.right[kNostrils] += breath;
  return units;
}

void FaceMotion::PlaceMouth(vm::Time t, const SpeechMotion::Mouth& speech, FaceState& state) const {
  const auto contact = static_cast<float>(speech.share * speech.pose.contact);
  for (std::size_t unit = 0; unit < kActionUnits; ++unit) {
    if (!tables_.units.opens[unit]) continue;
    state.au_left[unit] *= 1 - contact;
    state.au_right[unit] *= 1 - contact;
  }
  double scale = mouth_scale_.At(t) / kFullMouthScale;
  if (scale > 1) scale = 1 + (scale - 1) * (1 - contact);  // a contact is no larger than it is
  for (std::size_t i = 0; i < kMouthParameters; ++i) {
    state.mouth[i] =
        Mix(mouth_[i].At(t), static_cast<float>(scale * speech.pose.mouth[i]), speech.share);
  }
  state.lip_seal = static_cast<float>(speech.share * speech.pose.seal);
  state.tongue = static_cast<float>(speech.share * speech.pose.tongue);
}

double FaceMotion::LidsShutAt(vm::Time t) const {
  double shut = std::max(eyes_.LidsShutAt(t), idle_.LidsShutAt(t));
  const bool at_end = idle_.On(IdleKind::kEndBlink);
  const bool at_shifts = idle_.On(IdleKind::kGazeBlink) && idle_.On(IdleKind::kAvert);
  if ((!at_end && !at_shifts) || tables_.motions.blinks.empty()) return shut;
  const AutoAvert* avert = Avert();
  const auto moments = speech_.LastMoments(avert == nullptr ? 1e9 : avert->shortest_ms);
  if (!moments) return shut;
  const auto blink = [&](vm::Time start) {
    shut = std::max(shut, LidsAt(tables_.motions.blinks.front(), t - start));
  };
  // Most utterances end with a blink, just before or after the last sound.
  if (at_end && RandomAt(seed_, kEndBlink, utterances_) < 0.6) {
    blink(moments->end + FromMs(20 + 90 * RandomAt(seed_, kEndBlinkTime, utterances_)));
  }
  if (at_shifts && moments->away) {
    if (RandomAt(seed_, kAvertBlink, 2 * utterances_) < 0) blink(*moments->away);
    if (RandomAt(seed_, kAvertBlink, 2 * utterances_ + 1) < 0) blink(*moments->back);
  }
  return shut;
}

void FaceMotion::PlaceHeadAndEyes(vm::Time t, const SpeechMotion::Mouth& speech,
                                  const SpeechMotion::Gesture& gesture, const ActionUnits& units,
                                  FaceState& state) const {
  // Movement by itself and with the speech; the eyes stay where they look meanwhile.
  Angles own = idle_.HeadAt(t, speech.over_emotion);
  if (const std::size_t pattern = idle_.Pattern(IdleKind::kSpeech); pattern > 0) {
    const AutoSpeech& size = tables_.motions.auto_speeches[pattern - 1];
    const double weight = idle_.Weight(IdleKind::kSpeech, t);
    own[0] += static_cast<float>(weight * size.nod * gesture.head.nod);
    own[1] += static_cast<float>(weight * size.turn * gesture.head.turn);
    own[2] += static_cast<float>(weight * size.tilt * gesture.head.tilt);
  }
  const Angles told = head_.At(t);
  const float on_user = on_user_.At(t);
  EyeAngles away{};
  const EyeAngles idle = idle_.EyesAt(t);
  const float thinking = thinking_.At(t);
  const EyeAngles thought = thinking > 0 ? idle_.ThinkingAt(t, thinking_since_) : EyeAngles{};
  const AutoAvert* avert = Avert();
  const double averted = avert == nullptr ? 0 : avert->angle * idle_.Weight(IdleKind::kAvert, t);
  for (std::size_t i = 0; i < 2; ++i) {
    const float steady = own[i] + on_user * std::clamp(told[i], -35.0f, 35.0f);
    away[i] =
        idle[i] + thinking * thought[i] + static_cast<float>(averted * gesture.avert[i]) - steady;
  }

  // On the wire, and so in all the parts, x+ is down; the state's eyes count up as positive.
  EyeAngles left = eyes_.LeftAt(t);
  EyeAngles right = eyes_.RightAt(t);
  const float vergence = vergence_deg_.At(t);
  for (std::size_t i = 0; i < 2; ++i) {
    left[i] += away[i] + units.gaze_left[i] - (i == 1 ? vergence : 0);
    right[i] += away[i] + units.gaze_right[i] + (i == 1 ? vergence : 0);
  }
  const EyeAngles follows = eyes_.HeadShareAt(t);
  for (std::size_t i = 0; i < 3; ++i) {
    state.head_rotation[i] = told[i] + own[i] + (i < 2 ? follows[i] : 0);
  }
  for (const auto& [number, track] : codes_) {
    const UnitCode& code = tables_.unit_names.codes.at(number);
    const float weight = track.At(t);
    for (std::size_t i = 0; i < 3; ++i) state.head_rotation[i] += weight * code.head[i];
    for (std::size_t i = 0; i < 2; ++i) {
      left[i] += weight * code.left_eye[i];
      right[i] += weight * code.right_eye[i];
    }
    state.head_forward += weight * code.forward_mm;
  }
  state.eye_left = {-left[0], left[1]};
  state.eye_right = {-right[0], right[1]};
  state.blink_left = state.blink_right = static_cast<float>(LidsShutAt(t));
}

FaceState FaceMotion::StateAt(vm::Time t) const {
  FaceState state = figure_;
  const SpeechMotion::Mouth speech = speech_.At(t);
  const AutoAvert* avert = Avert();
  const SpeechMotion::Gesture gesture =
      speech_.GestureAt(t, avert == nullptr ? 1e9 : avert->shortest_ms);
  const ActionUnits units = UnitsAt(t, speech, gesture);
  for (std::size_t unit = 0; unit < kActionUnits; ++unit) {
    state.au_left[unit] = std::clamp(units.left[unit] + units_left_[unit].At(t), 0.0f, 2.0f);
    state.au_right[unit] = std::clamp(units.right[unit] + units_right_[unit].At(t), 0.0f, 2.0f);
  }
  PlaceMouth(t, speech, state);
  PlaceHeadAndEyes(t, speech, gesture, units, state);
  return state;
}

template <typename Visit>
void FaceMotion::ForEachTrack(const Visit& visit) const {
  for (const auto* tracks : {&units_left_, &units_right_}) {
    for (const auto& track : *tracks) visit(track);
  }
  for (const auto& track : mouth_) visit(track);
  for (const auto& track : emotions_) visit(track);
  for (const auto& [number, track] : codes_) visit(track);
  for (const auto& [name, track] : blend_shapes_) visit(track);
  for (const auto* track : {&on_user_, &thinking_, &vergence_deg_}) visit(*track);
}

std::optional<vm::Time> FaceMotion::NextActivity(vm::Time t) const {
  if (thinking_.At(t) > 0) return t;
  std::optional<vm::Time> next = speech_.NextActivity(t);
  next = Earlier(next, expression_.NextActivity(t));
  next = Earlier(next, head_.NextActivity(t));
  next = Earlier(next, eyes_.NextActivity(t));
  next = Earlier(next, idle_.NextActivity(t));
  next = Earlier(next, mouth_scale_.NextActivity(t));
  ForEachTrack([&](const Track<float>& track) { next = Earlier(next, track.NextActivity(t)); });
  return next;
}

vm::Time FaceMotion::OnsetsSettled(vm::Time t) const {
  vm::Time settled = std::max({expression_.SettledAt(t), head_.SettledAt(t), eyes_.SettledAt(t)});
  ForEachTrack([&](const Track<float>& track) { settled = std::max(settled, track.SettledAt(t)); });
  return settled;
}

vm::Time FaceMotion::FiniteEnd(vm::Time t) const {
  return std::max({t, expression_.End().value_or(t), eyes_.End().value_or(t), head_.MovesEnd(t),
                   eyes_.BlinksEnd(t)});
}

}  // namespace fsm
