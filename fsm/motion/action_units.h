#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "fsm/rig/face_state.h"
#include "vm_protocol/core/result.h"

namespace fsm {

class TableRow;
struct UnitNames;

/// Weights of all action units, and where the eyes go with them.
struct ActionUnits {
  Sided<UnitValues> au;
  Sided<EyeAngles> gaze;
};
ActionUnits Mix(const ActionUnits& a, const ActionUnits& b, double share_of_b);
/// Calls `change(strength in to, strength in other)` for every number that either of them has.
template <typename Change>
void Combine(UnitValues& to, const UnitValues& other, const Change& change) {
  const std::size_t others = other.size();
  if (others > to.size()) to[others - 1] = 0;  // it grows
  const std::size_t all = to.size();
  float* const own = &to[0];
  const float* const from = other.begin();
  for (std::size_t unit = 0; unit < others; ++unit) change(own[unit], from[unit]);
  for (std::size_t unit = others; unit < all; ++unit) change(own[unit], 0.0f);
}
/// a + weight * b.
void AddTo(ActionUnits& a, const ActionUnits& b, double weight);

/// Reads words from `first` on: AU[L|R]:WEIGHT, gaze[L|R]:DOWN,RIGHT. Throws TableError.
ActionUnits ReadUnits(const TableRow& row, std::size_t first, const UnitNames& names);

enum class Region { kEye, kBrow, kMouth };
inline constexpr std::size_t kRegions = 3;

/// What the numbers of the slot Face.N stand for, and which part of the face a unit belongs to.
struct UnitList {
  std::vector<int> units;             ///< Face.1 is units[0]; 0 = not an action unit
  std::vector<std::string> emotions;  ///< by position as well; "" = not an emotion
  std::vector<Region> regions;        ///< by number, see RegionOf
  std::vector<bool> opening;          ///< by number, see Opens

  /// A unit that the table gives no region belongs to the mouth.
  Region RegionOf(std::size_t unit) const {
    return unit < regions.size() ? regions[unit] : Region::kMouth;
  }
  /// Parts the lips: gives way to contacts of speech.
  bool Opens(std::size_t unit) const { return unit < opening.size() && opening[unit]; }
};
/// tables/action_unit_list.txt and tables/arkit.txt; `name` is for messages.
/// Errors: kBadValue "NAME:LINE: what was expected".
vm::Result<UnitList> ReadUnitList(const std::string& name, std::string_view text,
                                  const UnitNames& names);

/// Blend shapes by name.
using BlendShapes = std::map<std::string, ActionUnits, std::less<>>;
vm::Result<BlendShapes> ReadBlendShapes(const std::string& name, std::string_view text,
                                        const UnitNames& names);

}  // namespace fsm
