#include "fsm/motion/face_motion.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cassert>

namespace fsm {
namespace {

using namespace std::chrono_literals;

constexpr vm::Time kUnitMove = 60ms;   // units that are just set
constexpr vm::Time kHeadTurn = 120ms;  // quick, but not at once
constexpr vm::Time kScaleMove = 100ms;

// What one unit of Mouth.N at 100 % means, mm or (jaw Y) degrees.
constexpr std::array<float, kMouthParameters> kMouthUnit = {4, 4, 4,  4, -6, 4, -6, 4, 5,
                                                            5, 5, 15, 4, 1,  1, 1,  1};

template <typename Map>
std::string KeysOf(const Map& map) {
  std::vector<std::string> keys;
  for (const auto& [key, value] : map) keys.push_back(key);
  return fmt::format("{}", fmt::join(keys, " "));
}

vm::Result<void> CheckPattern(std::string_view kind, int pattern, int lowest, std::size_t count) {
  if (pattern >= lowest && pattern <= static_cast<int>(count)) return {};
  if (count == 0) {
    return vm::Fail(vm::Errc::kBadValue, fmt::format("there is no pattern of {}", kind));
  }
  return vm::Fail(vm::Errc::kBadValue, fmt::format("{} has no pattern {}; {} to {} expected", kind,
                                                   pattern, lowest, count));
}

}  // namespace

FaceMotion::FaceMotion(MotionTables tables, std::uint64_t seed)
    : tables_(std::move(tables)),
      autonomy_(tables_.motions, seed),
      emotions_(tables_.units.emotions.size()) {}

vm::Result<void> FaceMotion::Express(vm::Time now, std::string_view name, int pattern,
                                     double strength, vm::Time duration) {
  const auto found = tables_.emotions.find(name);
  if (found == tables_.emotions.end()) {
    return vm::Fail(vm::Errc::kBadValue,
                    fmt::format("'{}' is no expression; {} or NEUTRAL expected", name,
                                KeysOf(tables_.emotions)));
  }
  const Emotion& emotion = found->second;
  if (auto fits = CheckPattern(name, pattern, 1, emotion.patterns.size()); !fits) return fits;
  ActionUnits look;
  AddTo(look, emotion.patterns[static_cast<std::size_t>(pattern - 1)], strength);
  const vm::Time onset =
      settings_.natural_expressions ? FromMs(emotion.onset_ms) : settings_.expression;
  expression_.Show(now, look, emotion.lag_ms, onset, duration);
  return {};
}

void FaceMotion::Neutral(vm::Time now) {
  expression_.Neutral(now, settings_.natural_expressions ? vm::Time(500ms) : settings_.expression);
}

vm::Result<void> FaceMotion::SetFace(vm::Time now, int position, double strength) {
  const auto index = static_cast<std::size_t>(position - 1);
  const auto value = static_cast<float>(strength);
  if (position >= 1 && index < tables_.units.units.size()) {
    if (const int unit = tables_.units.units[index]; unit > 0) {
      units_left_[static_cast<std::size_t>(unit)].MoveTo(now, value, kUnitMove);
      units_right_[static_cast<std::size_t>(unit)].MoveTo(now, value, kUnitMove);
      return {};
    }
    if (tables_.emotions.contains(tables_.units.emotions[index])) {
      emotions_[index].MoveTo(now, value, settings_.expression);
      return {};
    }
  }
  return vm::Fail(vm::Errc::kBadValue,
                  fmt::format("the list of units has no position {}", position));
}

vm::Result<void> FaceMotion::SetMouth(vm::Time now, int parameter, double strength) {
  const auto index = static_cast<std::size_t>(parameter - 1);
  if (parameter < 1 || index >= kMouthParameters) {
    return vm::Fail(vm::Errc::kBadValue,
                    fmt::format("{} is no mouth parameter; 1 to 17 expected", parameter));
  }
  mouth_[index].MoveTo(now, static_cast<float>(strength) * kMouthUnit[index], kUnitMove);
  return {};
}

vm::Result<void> FaceMotion::SetUnit(vm::Time now, std::string_view name, double strength,
                                     vm::Time move) {
  const auto unit = ParseUnitName(name);
  if (!unit) return std::unexpected(unit.error());
  const auto index = static_cast<std::size_t>(unit->number);
  if (unit->left) units_left_[index].MoveTo(now, static_cast<float>(strength), move);
  if (unit->right) units_right_[index].MoveTo(now, static_cast<float>(strength), move);
  return {};
}

vm::Result<void> FaceMotion::SetBlendShape(vm::Time now, std::string_view name, double weight,
                                           vm::Time move) {
  const auto found = tables_.blend_shapes.find(name);
  if (found == tables_.blend_shapes.end()) {
    return vm::Fail(vm::Errc::kBadValue, fmt::format("'{}' is no blend shape; there are {}", name,
                                                     KeysOf(tables_.blend_shapes)));
  }
  blend_shapes_[found->first].MoveTo(now, static_cast<float>(weight), move);
  return {};
}

void FaceMotion::TurnEyes(vm::Time now, bool left, bool right, double x, double y,
                          vm::Time duration) {
  eyes_.Turn(now, left, right, {static_cast<float>(x), static_cast<float>(y)}, settings_.eye_move,
             duration);
}

void FaceMotion::Gaze(vm::Time now, double x, double y, vm::Time duration) {
  eyes_.Gaze(now, {static_cast<float>(x), static_cast<float>(y)}, settings_.eye_move, duration);
}

void FaceMotion::TurnHead(vm::Time now, const Angles& angles) {
  head_.TurnTo(now, angles, kHeadTurn);
}

void FaceMotion::TurnHeadBy(vm::Time now, const Angles& angles) {
  head_.TurnBy(now, angles, kHeadTurn);
}

vm::Result<void> FaceMotion::Move(vm::Time now, std::string_view kind, int pattern) {
  if (kind == "BLINK") {
    const auto& blinks = tables_.motions.blinks;
    if (auto fits = CheckPattern(kind, pattern, 1, blinks.size()); !fits) return fits;
    eyes_.Blink(now, blinks[static_cast<std::size_t>(pattern - 1)]);
    return {};
  }
  const auto found = tables_.motions.head.find(kind);
  const std::size_t count = found == tables_.motions.head.end() ? 0 : found->second.size();
  if (auto fits = CheckPattern(kind, pattern, 1, count); !fits) return fits;
  head_.Play(now, found->second[static_cast<std::size_t>(pattern - 1)]);
  return {};
}

void FaceMotion::StopMoves(vm::Time now) {
  head_.StopMoves(now);
  eyes_.StopBlinks();
}

vm::Result<void> FaceMotion::Autonomous(vm::Time now, std::string_view kind, int pattern) {
  const MotionTable& table = tables_.motions;
  const auto index = static_cast<std::size_t>(std::max(pattern, 0));
  const std::size_t count = kind == "BLINK"  ? table.auto_blinks.size()
                            : kind == "MOVE" ? Autonomy::MovePatterns(table)
                            : kind == "GAZE" ? table.auto_gazes.size()
                                             : table.auto_userdef.size();
  if (pattern != 0) {
    if (auto fits = CheckPattern(kind, pattern, 0, count); !fits) return fits;
  }
  if (kind == "BLINK") autonomy_.Blink(now, index);
  if (kind == "MOVE") autonomy_.Move(now, index);
  if (kind == "GAZE") autonomy_.Gaze(now, index);
  if (kind == "USERDEF") autonomy_.Userdef(now, index);
  return {};
}

void FaceMotion::Speak(vm::Time now, const vm::PhonemeList& phonemes, vm::Time start) {
  speech_.Start(now, LipTrack(phonemes, tables_, settings_.lips), start);
}

std::vector<std::string> FaceMotion::UnknownPhonemes(const vm::PhonemeList& phonemes) const {
  return MakeDemands(phonemes, tables_, settings_.lips).unknown;
}

void FaceMotion::SetShapes(bool bilingual, MouthShapes shapes) {
  MouthShapes& own = (bilingual ? tables_.set28 : tables_.set14).shapes;
  assert(shapes.size() == own.size());
  for (std::size_t i = 0; i < own.size(); ++i) {
    const float contact = own[i].pose.contact;
    own[i].pose = shapes[i].pose;
    own[i].pose.contact = contact;
    own[i].hold = shapes[i].hold;
  }
}

void FaceMotion::StopSpeaking(vm::Time now) { speech_.Stop(now); }

void FaceMotion::Sync(vm::Time now, double voice_ms) {
  speech_.Sync(now, voice_ms + settings_.sync_offset_ms, settings_.sync_rate);
}

void FaceMotion::Apply(vm::Time now, const MotionSettings& settings) {
  const double lead = settings.lead_ms - settings.offset_ms;
  if (lead != settings_.lead_ms - settings_.offset_ms) speech_.SetLead(now, lead);
  if (settings.mouth_scale != settings_.mouth_scale) {
    mouth_scale_.MoveTo(now, static_cast<float>(settings.mouth_scale), kScaleMove);
  }
  settings_ = settings;
}

FaceState FaceMotion::StateAt(vm::Time t) const {
  FaceState state = figure_;
  const SpeechMotion::Mouth speech = speech_.At(t);

  const double mouth_share = 1 - (1 - kEmotionWhileSpeaking) * speech.over_emotion;
  ActionUnits units = expression_.At(t, tables_.units, mouth_share);
  for (std::size_t i = 0; i < emotions_.size(); ++i) {
    const float weight = emotions_[i].At(t);
    if (weight == 0) continue;
    ActionUnits look;
    AddTo(look, tables_.emotions.find(tables_.units.emotions[i])->second.patterns[0], weight);
    for (std::size_t unit = 0; unit < kActionUnits; ++unit) {
      if (tables_.units.region[unit] != Region::kMouth) continue;
      look.left[unit] = static_cast<float>(look.left[unit] * mouth_share);
      look.right[unit] = static_cast<float>(look.right[unit] * mouth_share);
    }
    AddTo(units, look, 1);
  }
  for (const auto& [name, track] : blend_shapes_) {
    AddTo(units, tables_.blend_shapes.find(name)->second, track.At(t));
  }
  for (std::size_t unit = 0; unit < kActionUnits; ++unit) {
    state.au_left[unit] = std::clamp(units.left[unit] + units_left_[unit].At(t), 0.0f, 2.0f);
    state.au_right[unit] = std::clamp(units.right[unit] + units_right_[unit].At(t), 0.0f, 2.0f);
  }

  const float contact = static_cast<float>(speech.share * speech.pose.contact);
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

  // On the wire, and so in all the parts, x+ is down; the state's eyes count up as positive.
  const EyeAngles idle = autonomy_.EyesAt(t);
  const EyeAngles left = eyes_.LeftAt(t);
  const EyeAngles right = eyes_.RightAt(t);
  state.eye_left = {-(left[0] + idle[0] + units.gaze_left[0]),
                    left[1] + idle[1] + units.gaze_left[1]};
  state.eye_right = {-(right[0] + idle[0] + units.gaze_right[0]),
                     right[1] + idle[1] + units.gaze_right[1]};
  const auto lids = static_cast<float>(std::max(eyes_.LidsShutAt(t), autonomy_.LidsShutAt(t)));
  state.blink_left = lids;
  state.blink_right = lids;

  const Angles turned = head_.At(t);
  const Angles own = autonomy_.HeadAt(t);
  for (std::size_t i = 0; i < 3; ++i) state.head_rotation[i] = turned[i] + own[i];
  const EyeAngles follows = eyes_.HeadShareAt(t);
  state.head_rotation[0] += follows[0];
  state.head_rotation[1] += follows[1];
  return state;
}

std::optional<vm::Time> FaceMotion::NextActivity(vm::Time t) const {
  std::optional<vm::Time> next = speech_.NextActivity(t);
  next = Earlier(next, expression_.NextActivity(t));
  next = Earlier(next, head_.NextActivity(t));
  next = Earlier(next, eyes_.NextActivity(t));
  next = Earlier(next, autonomy_.NextActivity(t));
  next = Earlier(next, mouth_scale_.NextActivity(t));
  for (const auto& track : units_left_) next = Earlier(next, track.NextActivity(t));
  for (const auto& track : units_right_) next = Earlier(next, track.NextActivity(t));
  for (const auto& track : mouth_) next = Earlier(next, track.NextActivity(t));
  for (const auto& track : emotions_) next = Earlier(next, track.NextActivity(t));
  for (const auto& [name, track] : blend_shapes_) next = Earlier(next, track.NextActivity(t));
  return next;
}

vm::Time FaceMotion::OnsetsSettled(vm::Time t) const {
  vm::Time settled = std::max({expression_.SettledAt(t), head_.SettledAt(t), eyes_.SettledAt(t)});
  const auto include = [&settled, t](const Track<float>& track) {
    settled = std::max(settled, track.SettledAt(t));
  };
  for (const auto& track : units_left_) include(track);
  for (const auto& track : units_right_) include(track);
  for (const auto& track : mouth_) include(track);
  for (const auto& track : emotions_) include(track);
  for (const auto& [name, track] : blend_shapes_) include(track);
  return settled;
}

vm::Time FaceMotion::FiniteEnd(vm::Time t) const {
  return std::max({t, expression_.End().value_or(t), eyes_.End().value_or(t), head_.MovesEnd(t),
                   eyes_.BlinksEnd(t)});
}

}  // namespace fsm
