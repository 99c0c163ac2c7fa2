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

/// The strengths of all action units, and the rotation of the eyes that goes with them.
struct ActionUnits {
  Sided<UnitValues> au;
  Sided<EyeAngles> gaze;
};
ActionUnits Mix(const ActionUnits& a, const ActionUnits& b, double share_of_b);
/// Calls `change(strength in to, strength in other)` for every unit number up to the greatest in
/// either; the strengths of `to` may be changed.
template <typename Change>
void Combine(UnitValues& to, const UnitValues& other, const Change& change) {
  const std::size_t others = other.size();
  if (others > to.size()) to[others - 1] = 0;  // resizes `to`
  const std::size_t all = to.size();
  float* const own = &to[0];
  const float* const from = other.begin();
  for (std::size_t unit = 0; unit < others; ++unit) change(own[unit], from[unit]);
  for (std::size_t unit = others; unit < all; ++unit) change(own[unit], 0.0f);
}
/// Adds weight * b to `a`.
void AddTo(ActionUnits& a, const ActionUnits& b, double weight);

/// Reads the words of a row from index `first` on: AU[L|R]:WEIGHT or gaze[L|R]:DOWN,RIGHT
/// (degrees). Throws TableError.
ActionUnits ReadUnits(const TableRow& row, std::size_t first, const UnitNames& names);

enum class Region { kEye, kBrow, kMouth };
inline constexpr std::size_t kRegions = 3;

/// The units and emotions that the slots Face.N set, and the part of the face of each unit.
struct UnitList {
  std::vector<int> units;             ///< Face.1 is units[0]; 0 = not an action unit
  std::vector<std::string> emotions;  ///< indexed as `units`; "" = not an emotion
  std::vector<Region> regions;        ///< indexed by unit number; see RegionOf
  std::vector<bool> opening;          ///< indexed by unit number; see Opens

  /// Returns the region of a unit, by default the mouth.
  Region RegionOf(std::size_t unit) const {
    return unit < regions.size() ? regions[unit] : Region::kMouth;
  }
  /// Tells whether a unit parts the lips. Such units are reduced while speech needs the lips in
  /// contact (MouthPose::contact).
  bool Opens(std::size_t unit) const { return unit < opening.size() && opening[unit]; }
};
/// Reads tables/action_unit_list.txt; `name` is the file name in messages.
/// Errors: kBadValue "NAME:LINE: what was expected".
vm::Result<UnitList> ReadUnitList(const std::string& name, std::string_view text,
                                  const UnitNames& names);

/// What each of ARKit's blend shapes looks like, by name; read from tables/arkit.txt.
using BlendShapes = std::map<std::string, ActionUnits, std::less<>>;
vm::Result<BlendShapes> ReadBlendShapes(const std::string& name, std::string_view text,
                                        const UnitNames& names);

}  // namespace fsm
