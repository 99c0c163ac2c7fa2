// Expressions and units: what FaceMotion is told about looks.

#include <algorithm>

#include "fsm/motion/face_motion.h"
#include "fsm/motion/motion_errors.h"

namespace fsm {
namespace {

using namespace std::chrono_literals;

constexpr vm::Time kUnitMove = 60ms;   // units that are just set
constexpr vm::Time kCodeMove = 120ms;  // heads and eyes take longer than skin
constexpr vm::Time kOffset = 500ms;    // of an expression, natural
constexpr int kMostPatterns = 20;
constexpr std::size_t kMostExpressions = 200;

// What one unit of Mouth.N at 100 % means, mm or (jaw Y) degrees.
constexpr std::array<float, kMouthParameters> kMouthUnit = {4, 4, 4,  4, -6, 4, -6, 4, 5,
                                                            5, 5, 15, 4, 1,  1, 1,  1};

}  // namespace

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
  if (idle_.On(IdleKind::kAsymmetry)) lags = side_lags_;
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
      SetOne(now,
             {.number = unit, .right = !IsOneSided(unit) || strength == 0, .strength = strength},
             kUnitMove);
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
    SetOne(now, one, command->ms || IsActionUnit(one.number) ? move : kCodeMove);
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

}  // namespace fsm
