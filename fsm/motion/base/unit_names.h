#pragma once

#include <array>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "fsm/base/side.h"
#include "fsm/motion/base/face_look.h"

namespace fsm {

/// The effect of a FACS code of head or eyes (51-58, 61-66) at full strength; see
/// tables/action_unit_names.txt.
struct HeadEyeCode {
  Angles head_rotation{};
  Sided<EyeAngles> gaze;
  float head_forward_mm = 0;
};

/// The action units and codes that exist, and their names.
struct UnitNames {
  std::map<std::string, int, std::less<>> by_name;  ///< in lower case
  std::map<int, std::string> names;
  std::map<int, HeadEyeCode> codes;
  std::set<int> one_sided;

  /// The names of the built-in table.
  static const UnitNames& BuiltIn();
  bool IsUnit(int number) const { return names.contains(number) && !codes.contains(number); }
  /// Tells whether a unit is inherently of one side: the jaw sideways (30), a wink (46). Set
  /// without a side, it acts on the agent's left; reset without a side, on both.
  bool IsOneSided(int number) const { return one_sided.contains(number); }
};
/// Reads tables/action_unit_names.txt. Errors: kBadValue "NAME:LINE: what was expected".
vm::Result<UnitNames> ReadUnitNames(const std::string& name, std::string_view text);

/// A unit given by number or name, with an optional side: "12", "12L", "R12", "LipCornerPuller.R".
struct UnitName {
  int number = 0;
  Sided<bool> sides{true, true};  ///< those it is asked of
};
/// Parses the name of a unit. Error: kBadValue for any other word; codes are not units.
vm::Result<UnitName> ParseUnitName(std::string_view word, const UnitNames& names);

/// A unit or code that a command sets. Codes have no sides.
struct UnitSetting : UnitName {
  double strength = 1;  ///< 0..2
};
/// Leaves a unit that is inherently of one side only the agent's left if it has both and is not
/// reset.
void KeepOwnSide(UnitSetting& unit, const UnitNames& names);
/// The strengths of the intensity letters of FACS, A trace .. E maximum (Ekman and Friesen 1978).
inline constexpr std::array<double, 5> kIntensity = {0.1, 0.3, 0.5, 0.75, 1.0};

struct UnitCommand {
  std::vector<UnitSetting> settings;
  std::optional<double> ms;  ///< the number at the end, if there is one
};
/// Parses any number of settings such as `12L 0.7`, `12L C`, `12C`, `R12C`, `LipCornerPuller 0.7`,
/// `LipCornerPuller.L 0.7` or `12L:0.7`, and perhaps a number of ms at the end. Names are not
/// case-sensitive and take precedence over numbers with a letter: where a unit is called 58b, 58B
/// is that unit. Error: kBadValue with the offending word, its position and what was expected.
vm::Result<UnitCommand> ParseUnitCommand(std::string_view text, const UnitNames& names);
/// Parses the look of an expression: action units (no codes) and `gaze[L|R]:DOWN,RIGHT` in degrees.
/// Error: kBadValue.
vm::Result<FaceLook> ParseLook(std::string_view text, const UnitNames& names);
/// Formats a look as ParseLook reads it: `6:0.7 12L:0.8 gaze:6,0`.
std::string FormatLook(const FaceLook& look, const UnitNames& names);

}  // namespace fsm
