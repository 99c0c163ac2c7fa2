#pragma once

#include <glm/vec3.hpp>
#include <map>
#include <string>
#include <string_view>

#include "embedded/appearance_numbers.h"
#include "fsm/base/number_table.h"
#include "fsm/rig/head.h"

namespace fsm {

/// How things look: what tables/appearance.txt says, where each number is explained. Constant after
/// construction; thread: any.
class Appearance : public AppearanceNumbers {
 public:
  /// How a surface takes light; the names are those of the uniforms in surface_*.glsl.
  struct Surface {
    glm::vec3 wrap{0};
    glm::vec3 lobes{0};
    float key_through = 0, sheen = 0, saturation = 1, bump = 0, planar = 0;
  };

  /// In place of the built-in table; `name` is for messages. Throws as NumberTable, and where a
  /// lamp stands nowhere.
  Appearance(const std::string& name, std::string_view text)
      : Appearance(NumberTable(name, text, &BuiltIn().table_)) {}
  static const Appearance& BuiltIn();

  /// REQUIRES: a material with rows in the table.
  const Surface& surface(Material material) const { return surfaces_.at(material); }
  /// The rows whose name is one word as constants of GLSL: "const vec3 sky_color = vec3(...);". A
  /// compiler folds them, so a number in the table costs no more than one in a shader.
  const std::string& constants() const { return constants_; }

 private:
  explicit Appearance(NumberTable numbers);

  NumberTable table_;
  std::map<Material, Surface> surfaces_;
  std::string constants_;
};

}  // namespace fsm
