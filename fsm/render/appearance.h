#pragma once

#include <glm/vec3.hpp>
#include <map>
#include <string>
#include <string_view>

#include "embedded/appearance_numbers.h"
#include "fsm/base/number_table.h"
#include "fsm/rig/head.h"

namespace fsm {

/// The look of all materials and lamps, read from tables/appearance.txt, which explains each
/// number. Constant after construction; thread: any.
class Appearance : public AppearanceNumbers {
 public:
  /// How a surface reflects light; the members are named after the uniforms in surface_*.glsl.
  struct Surface {
    glm::vec3 wrap{0};
    glm::vec3 lobes{0};
    float key_through = 0, sheen = 0, saturation = 1, bump = 0, detail_per_mm = 0;
  };

  /// Reads a table that overrides the built-in one; `name` appears in error messages. Throws as
  /// NumberTable does, and for a lamp whose direction is zero.
  Appearance(const std::string& name, std::string_view text)
      : Appearance(NumberTable(name, text, &BuiltIn().table_)) {}
  static const Appearance& BuiltIn();

  /// REQUIRES: the table has rows for this material.
  const Surface& surface(Material material) const { return surfaces_.at(material); }
  /// Returns the rows with names of one word as GLSL constants: "const vec3 look_sky_colour =
  /// vec3(...);". The compiler folds them, so a number of the table costs nothing extra.
  const std::string& constants() const { return constants_; }

 private:
  explicit Appearance(NumberTable numbers);

  NumberTable table_;
  std::map<Material, Surface> surfaces_;
  std::string constants_;
};

}  // namespace fsm
