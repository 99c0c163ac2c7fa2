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

/// What a slot Face.N sets: an action unit or an emotion.
struct FaceSlot {
  int unit = 0;         ///< 0 = not an action unit
  std::string emotion;  ///< "" = not an emotion
};

/// The region of the face of each unit.
struct UnitRegions {
  std::vector<Region> regions;  ///< indexed by unit number; see RegionOf
  std::vector<bool> opens;      ///< indexed by unit number; see Opens

  /// Returns the region of a unit, by default the mouth.
  Region RegionOf(std::size_t unit) const {
    return unit < regions.size() ? regions[unit] : Region::kMouth;
  }
  /// Tells whether a unit parts the lips. Such units are reduced while speech needs the lips in
  /// contact (MouthPose::contact).
  bool Opens(std::size_t unit) const { return unit < opens.size() && opens[unit]; }
};

struct UnitList {
  std::vector<FaceSlot> face_slots;  ///< Face.1 is the first
  UnitRegions regions;
};
/// Reads tables/action_unit_list.txt; `name` is the file name in messages.
/// Errors: kBadValue "NAME:LINE: what was expected".
vm::Result<UnitList> ReadUnitList(const std::string& name, std::string_view text,
                                  const UnitNames& names);

}  // namespace fsm
