#pragma once

#include <map>
#include <string>
#include <string_view>

#include "fsm/rig/face_state.h"
#include "vm_protocol/core/result.h"

namespace fsm {

class TableRow;
struct UnitNames;

/// The strengths of all action units, and the rotation of the eyes that goes with them.
struct FaceLook {
  Sided<UnitValues> au;
  Residuals residuals{};  ///< as FaceState::residuals; no table has them
  Sided<EyeAngles> gaze;
};
FaceLook Mix(const FaceLook& a, const FaceLook& b, double share_of_b);
/// Calls `change(strength in to, strength in other)` for every unit number up to the greatest in
/// either; the strengths of `to` may be changed.
template <typename Change>
void ForEachUnit(UnitValues& to, const UnitValues& other, const Change& change) {
  const std::size_t others = other.size();
  if (others > to.size()) to[others - 1] = 0;  // resizes `to`
  const std::size_t all = to.size();
  float* const own = &to[0];
  const float* const from = other.begin();
  for (std::size_t unit = 0; unit < others; ++unit) change(own[unit], from[unit]);
  for (std::size_t unit = others; unit < all; ++unit) change(own[unit], 0.0f);
}
/// Adds weight * b to `a`.
void AddTo(FaceLook& a, const FaceLook& b, double weight);

/// Reads the words of a row from index `first` on as ParseLook does; without any the look is at
/// rest. Throws TableError.
FaceLook ReadLook(const TableRow& row, std::size_t first, const UnitNames& names);

/// What each of ARKit's blend shapes looks like, by name; read from tables/arkit.txt.
using BlendShapes = std::map<std::string, FaceLook, std::less<>>;
vm::Result<BlendShapes> ReadBlendShapes(const std::string& name, std::string_view text,
                                        const UnitNames& names);

}  // namespace fsm
