#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "vm_protocol/core/result.h"

namespace fsm {

struct UnitNames;

enum class Region { kEye, kBrow, kMouth };
inline constexpr std::size_t kRegions = 3;

/// The units and emotions that the slots Face.N set, and the part of the face of each unit.
struct UnitList {
  std::vector<int> units;             ///< Face.1 is units[0]; 0 = not an action unit
  std::vector<std::string> emotions;  ///< indexed as `units`; "" = not an emotion
  std::vector<Region> regions;        ///< indexed by unit number; see RegionOf
  std::vector<bool> opens;            ///< indexed by unit number; see Opens

  /// Returns the region of a unit, by default the mouth.
  Region RegionOf(std::size_t unit) const {
    return unit < regions.size() ? regions[unit] : Region::kMouth;
  }
  /// Tells whether a unit parts the lips. Such units are reduced while speech needs the lips in
  /// contact (MouthPose::contact).
  bool Opens(std::size_t unit) const { return unit < opens.size() && opens[unit]; }
};
/// Reads tables/action_unit_list.txt; `name` is the file name in messages.
/// Errors: kBadValue "NAME:LINE: what was expected".
vm::Result<UnitList> ReadUnitList(const std::string& name, std::string_view text,
                                  const UnitNames& names);

}  // namespace fsm
