#pragma once

#include <array>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "fsm/rig/face_state.h"
#include "vm_protocol/core/result.h"

namespace fsm {

class TableText;
struct TableLine;

/// Weights of all action units, left and right, and where the eyes go with them (degrees, x+ =
/// down, y+ = to the viewer's right, each eye).
struct ActionUnits {
  UnitValues left;
  UnitValues right;
  std::array<float, 2> gaze_left{};
  std::array<float, 2> gaze_right{};
};
ActionUnits Mix(const ActionUnits& a, const ActionUnits& b, double share_of_b);
/// a + weight * b.
void AddTo(ActionUnits& a, const ActionUnits& b, double weight);

/// True for the 44 numbers of FACS that FaceState has room for.
bool IsActionUnit(int number);

/// Units that are of one side by what they are: the jaw sideways (30), a wink (46). Asked for
/// without a side they are of the agent's left; taken back without one they go on both.
bool IsOneSided(int number);

/// "12", "12L" or "12R".
struct UnitName {
  int number = 0;
  bool left = true;
  bool right = true;
};
vm::Result<UnitName> ParseUnitName(std::string_view word);

/// Reads words from `first` on: AU[L|R]:WEIGHT, gaze[L|R]:DOWN,RIGHT.
vm::Result<ActionUnits> ReadUnits(const TableText& table, const TableLine& line, std::size_t first);

enum class Region { kEye, kBrow, kMouth };
inline constexpr std::size_t kRegions = 3;

/// What the numbers of the slot Face.N stand for, and which part of the face a unit belongs to.
struct UnitList {
  std::vector<int> units;             ///< Face.1 is units[0]; 0 = not an action unit
  std::vector<std::string> emotions;  ///< by position as well; "" = not an emotion
  std::array<Region, kActionUnits> region{};
  std::array<bool, kActionUnits> opens{};  ///< parts the lips: gives way to contacts of speech
};
vm::Result<UnitList> ReadUnitList(const std::string& name, std::string_view text);

/// Blend shapes by name.
using BlendShapes = std::map<std::string, ActionUnits, std::less<>>;
vm::Result<BlendShapes> ReadBlendShapes(const std::string& name, std::string_view text);

}  // namespace fsm
