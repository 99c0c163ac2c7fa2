#include "fsm/motion/face_motion.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

#include "fsm/motion/random.h"

namespace fsm {
namespace {

using namespace std::chrono_literals;

constexpr vm::Time kUnitMove = 60ms;   // units that are just set
constexpr vm::Time kHeadTurn = 120ms;  // quick, but not at once
constexpr vm::Time kScaleMove = 100ms;
constexpr vm::Time kOffset = 500ms;  // of an expression, natural
constexpr int kMostPatterns = 20;
constexpr std::size_t kMostExpressions = 200;
enum Stream : std::uint64_t { kShiftBlink = 300 };

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

// A strength as commands may give it.
vm::Result<void> CheckStrength(double strength) {
  if (strength >= 0 && strength <= 2) return {};
  return vm::Fail(vm::Errc::kBadValue,
                  fmt::format("{:g} is no strength; 0 to 2 expected, 1 = full", strength));
}

}  // namespace

FaceMotion::FaceMotion(MotionTables tables, std::uint64_t seed)
    : tables_(std::move(tables)),
      table_emotions_(tables_.emotions),
      seed_(seed),
      side_lags_(SideLagsOf(seed)),
      autonomy_(tables_.motions, seed),
      emotions_(tables_.units.emotions.size()) {}

// ---- expressions

vm::Time FaceMotion::OnsetOf(const Emotion& emotion) const {
  switch (settings_.onset) {
    case Onset::kPosed:
      return FromMs(emotion.posed.onset_ms);
    case Onset::kElicited:
      return FromMs(emotion.elicited.onset_ms);
    case Onset::kFixed:
      break;
  }
  return settings_.expression;
}

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
  if (auto fits = CheckStrength(strength); !fits) return fits;
  ActionUnits look;
  AddTo(look, emotion.patterns[static_cast<std::size_t>(pattern - 1)], strength);
  const Emotion::Timing& timing =
      settings_.onset == Onset::kElicited ? emotion.elicited : emotion.posed;
  ExpressionMotion::Sides lags{};
  if (autonomy_.On(Life::kAsymmetry)) lags = side_lags_;
  expression_.Show(now, look, timing.lag_ms, lags, OnsetOf(emotion), duration);
  return {};
}

void FaceMotion::Neutral(vm::Time now) {
  expression_.Neutral(now, settings_.onset == Onset::kFixed ? settings_.expression : kOffset);
}

vm::Result<void> FaceMotion::DefineExpression(std::string_view name, int pattern,
                                              std::string_view look) {
  const bool plain = !name.empty() && name.size() <= 40 && std::ranges::all_of(name, [](char c) {
    return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_';
  });
  if (!plain || name == "NEUTRAL") {
    return vm::Fail(
        vm::Errc::kBadValue,
        fmt::format("'{}' cannot be the name of an expression; up to 40 letters, digits "
                    "and _ expected, and not NEUTRAL",
                    name.substr(0, 60)));
  }
  auto units = ParseLook(look, tables_.unit_names);
  if (!units) return std::unexpected(units.error());
  const auto found = tables_.emotions.find(name);
  const std::size_t have = found == tables_.emotions.end() ? 0 : found->second.patterns.size();
  if (pattern < 1 || static_cast<std::size_t>(pattern) > have + 1 || pattern > kMostPatterns) {
    return vm::Fail(vm::Errc::kBadValue, fmt::format("{} has {} patterns; pattern 1 to {} expected",
                                                     name, have, have + 1));
  }
  if (have == 0 && tables_.emotions.size() >= kMostExpressions) {
    return vm::Fail(vm::Errc::kLimit, fmt::format("more than {} expressions", kMostExpressions));
  }
  auto& patterns = tables_.emotions[std::string(name)].patterns;
  patterns.resize(std::max(have, static_cast<std::size_t>(pattern)));
  patterns[static_cast<std::size_t>(pattern - 1)] = *units;
  return {};
}

void FaceMotion::ForgetExpression(std::string_view name) {
  if (const auto built_in = table_emotions_.find(name); built_in != table_emotions_.end()) {
    tables_.emotions[built_in->first] = built_in->second;
  } else if (const auto own = tables_.emotions.find(name); own != tables_.emotions.end()) {
    tables_.emotions.erase(own);
  }
}

// ---- units

vm::Result<void> FaceMotion::SetFace(vm::Time now, int position, double strength) {
  if (auto fits = CheckStrength(strength); !fits) return fits;
  const auto index = static_cast<std::size_t>(position - 1);
  const auto value = static_cast<float>(strength);
  if (position >= 1 && index < tables_.units.units.size()) {
    if (const int unit = tables_.units.units[index]; unit > 0) {
      units_left_[static_cast<std::size_t>(unit)].MoveTo(now, value, kUnitMove);
      units_right_[static_cast<std::size_t>(unit)].MoveTo(now, value, kUnitMove);
      return {};
    }
    if (const auto found = tables_.emotions.find(tables_.units.emotions[index]);
        found != tables_.emotions.end()) {
      emotions_[index].MoveTo(now, value, OnsetOf(found->second));
      return {};
    }
  }
  return vm::Fail(vm::Errc::kBadValue,
                  fmt::format("the list of units has no position {}", position));
}

vm::Result<void> FaceMotion::SetMouth(vm::Time now, int parameter, double strength) {
  if (auto fits = CheckStrength(strength); !fits) return fits;
  const auto index = static_cast<std::size_t>(parameter - 1);
  if (parameter < 1 || index >= kMouthParameters) {
    return vm::Fail(vm::Errc::kBadValue,
                    fmt::format("{} is no mouth parameter; 1 to 17 expected", parameter));
  }
  mouth_[index].MoveTo(now, static_cast<float>(strength) * kMouthUnit[index], kUnitMove);
  return {};
}

void FaceMotion::SetOne(vm::Time now, const UnitSetting& unit, vm::Time move) {
  const auto value = static_cast<float>(unit.strength);
  if (!IsActionUnit(unit.number)) {
    codes_[unit.number].MoveTo(now, value, move);
    return;
  }
  const auto index = static_cast<std::size_t>(unit.number);
  if (unit.left) units_left_[index].MoveTo(now, value, move);
  if (unit.right) units_right_[index].MoveTo(now, value, move);
}

vm::Result<void> FaceMotion::SetUnit(vm::Time now, std::string_view unit, double strength,
                                     vm::Time move) {
  if (auto fits = CheckStrength(strength); !fits) return fits;
  const auto command =
      ParseUnitCommand(fmt::format("{} {:.6f}", unit, strength), tables_.unit_names, false);
  if (!command) return std::unexpected(command.error());
  for (const UnitSetting& one : command->units) SetOne(now, one, move);
  return {};
}

vm::Result<void> FaceMotion::SetUnits(vm::Time now, std::string_view text) {
  const auto command = ParseUnitCommand(text, tables_.unit_names, true);
  if (!command) return std::unexpected(command.error());
  const vm::Time move = command->ms ? FromMs(*command->ms) : kUnitMove;
  for (const UnitSetting& one : command->units) {
    // Heads and eyes take longer than skin.
    SetOne(now, one, command->ms || IsActionUnit(one.number) ? move : kHeadTurn);
  }
  return {};
}

vm::Result<void> FaceMotion::CheckBlendShape(std::string_view name) const {
  if (tables_.blend_shapes.contains(name)) return {};
  return vm::Fail(vm::Errc::kBadValue, fmt::format("'{}' is no blend shape; there are {}", name,
                                                   KeysOf(tables_.blend_shapes)));
}

vm::Result<void> FaceMotion::SetBlendShape(vm::Time now, std::string_view name, double weight,
                                           vm::Time move) {
  if (auto fits = CheckStrength(weight); !fits) return fits;
  if (auto known = CheckBlendShape(name); !known) return known;
  blend_shapes_[std::string(name)].MoveTo(now, static_cast<float>(weight), move);
  return {};
}

// ---- eyes and head

void FaceMotion::TurnEyes(vm::Time now, bool left, bool right, double x, double y,
                          vm::Time duration) {
  eyes_.Turn(now, left, right, {static_cast<float>(x), static_cast<float>(y)}, settings_.eye_move,
             duration);
}

void FaceMotion::LookSomewhere(vm::Time now, bool user, bool think) {
  on_user_.MoveTo(now, user ? 1.0f : 0.0f, 2 * settings_.eye_move);
  thinking_.MoveTo(now, think ? 1.0f : 0.0f, settings_.eye_move);
  if (think) thinking_since_ = now;
  // Half the distance between the pupils, over the distance looked at; a thinker looks at nothing.
  constexpr double kHalfPupils = 31;
  const double near = settings_.gaze_distance_mm;
  const double angle =
      think || near <= 0 ? 0 : std::atan2(kHalfPupils, near) * 180 / std::numbers::pi;
  vergence_deg_.MoveTo(now, static_cast<float>(angle), 2 * settings_.eye_move);
}

void FaceMotion::BlinkAtShift(vm::Time now, const EyeAngles& from, const EyeAngles& to) {
  if (!autonomy_.On(Life::kGazeBlink) || tables_.motions.blinks.empty()) return;
  const double angle = std::hypot(to[0] - from[0], to[1] - from[1]);
  // Nearly always with large shifts, seldom with small ones (Evinger et al., Not looking while
  // leaping, 1994).
  const double chance = std::clamp(angle / 20, 0.0, 0.95);
  if ((RandomAt(seed_, kShiftBlink, ++shifts_) + 1) / 2 < chance) {
    eyes_.Blink(now, tables_.motions.blinks.front());
  }
}

void FaceMotion::Gaze(vm::Time now, double x, double y, vm::Time duration) {
  const EyeAngles to = {static_cast<float>(x), static_cast<float>(y)};
  BlinkAtShift(now, eyes_.GazeTarget(now), to);
  LookSomewhere(now, false, false);
  eyes_.Gaze(now, to, settings_.eye_move, duration);
}

void FaceMotion::LookAtUser(vm::Time now) {
  const EyeAngles from = thinking_.TargetAt(now) > 0 ? EyeAngles{-5, 11} : eyes_.GazeTarget(now);
  BlinkAtShift(now, from, {0, 0});
  LookSomewhere(now, true, false);
  eyes_.Gaze(now, {0, 0}, settings_.eye_move, vm::Time(0));
}

void FaceMotion::Think(vm::Time now) {
  BlinkAtShift(now, eyes_.GazeTarget(now), {-5, 11});
  LookSomewhere(now, false, true);
  eyes_.Gaze(now, {0, 0}, settings_.eye_move, vm::Time(0));
}

void FaceMotion::TurnHead(vm::Time now, const Angles& angles) {
  head_.TurnTo(now, angles, kHeadTurn);
}

void FaceMotion::TurnHeadBy(vm::Time now, const Angles& angles) {
  head_.TurnBy(now, angles, kHeadTurn);
}

vm::Result<void> FaceMotion::Move(vm::Time now, std::string_view kind, int pattern, double strength,
                                  int count) {
  if (kind == "SHAKE") kind = "REFUSE";
  if (kind == "TILT") kind = "LISTEN";
  if (!(strength >= 0 && strength <= 3) || count < 1 || count > 20) {
    return vm::Fail(
        vm::Errc::kBadValue,
        fmt::format("{:g} times the size and {} times found; 0 to 3 and 1 to 20 expected", strength,
                    count));
  }
  if (kind == "BLINK") {
    const auto& blinks = tables_.motions.blinks;
    if (auto fits = CheckPattern(kind, pattern, 1, blinks.size()); !fits) return fits;
    const BlinkPattern& blink = blinks[static_cast<std::size_t>(pattern - 1)];
    for (int i = 0; i < count; ++i) eyes_.Blink(now + i * LengthOf(blink), blink);
    return {};
  }
  const auto found = tables_.motions.head.find(kind);
  const std::size_t patterns = found == tables_.motions.head.end() ? 0 : found->second.size();
  if (auto fits = CheckPattern(kind, pattern, 1, patterns); !fits) return fits;
  head_.Play(now, found->second[static_cast<std::size_t>(pattern - 1)], strength, count);
  return {};
}

void FaceMotion::StopMoves(vm::Time now) {
  head_.StopMoves(now);
  eyes_.StopBlinks();
}

vm::Result<void> FaceMotion::Autonomous(vm::Time now, std::string_view kind, int pattern) {
  const auto life = LifeNamed(kind);
  if (!life) {
    return vm::Fail(vm::Errc::kBadValue, fmt::format("'{}' is nothing the face does by itself; {} "
                                                     "expected",
                                                     kind, fmt::join(kLifeNames, " ")));
  }
  if (pattern != 0) {
    const std::size_t count = tables_.motions.Patterns(*life);
    if (auto fits = CheckPattern(kind, pattern, 0, count); !fits) return fits;
  }
  autonomy_.Set(now, *life, static_cast<std::size_t>(pattern));
  return {};
}

vm::Result<void> FaceMotion::SetLife(vm::Time now, std::string_view profile) {
  LifeProfile wanted{};
  if (profile == "OFF") {
    wanted[static_cast<std::size_t>(Life::kAsymmetry)] = 1;
  } else {
    const auto found = tables_.motions.profiles.find(profile);
    if (found == tables_.motions.profiles.end()) {
      return vm::Fail(vm::Errc::kBadValue, fmt::format("'{}' is no way to live; {} or OFF expected",
                                                       profile, KeysOf(tables_.motions.profiles)));
    }
    wanted = found->second;
  }
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    const auto kind = static_cast<Life>(i);
    if (wanted[i] == (autonomy_.On(kind) ? autonomy_.Pattern(kind) : 0)) continue;
    autonomy_.Set(now, kind, wanted[i]);
  }
  return {};
}

void FaceMotion::SetPerson(std::uint64_t person) {
  side_lags_ = SideLagsOf(Scramble(seed_ ^ person));
}

// ---- speech

void FaceMotion::Speak(vm::Time now, const vm::PhonemeList& phonemes, vm::Time start) {
  const std::uint64_t seed = Scramble(seed_ + static_cast<std::uint64_t>(++utterances_));
  speech_.Start(now, LipTrack(phonemes, tables_, settings_.lips), start, seed);
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

}  // namespace fsm
