#pragma once

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "fsm/base/number_table.h"
#include "fsm/rig/head.h"

namespace fsm {

/// How things look: what tables/appearance.txt says, where each number is explained. Constant after
/// construction; thread: any.
class Appearance {
 public:
  /// How a surface takes light; the names are those of the uniforms in surface_*.glsl.
  struct Surface {
    glm::vec3 wrap{0};
    glm::vec3 lobes{0};
    float key_through = 0, sheen = 0, saturation = 1, bump = 0, planar = 0;
  };
  struct Lamp {
    glm::vec3 direction{0, 0, 1}, colour{0};
  };

  /// `name` is for messages. Throws std::runtime_error naming file and line where the text is no
  /// table, a name is unknown, missing or there twice, or has another count of numbers than in the
  /// built-in table, or numbers beyond -1000..1000.
  Appearance(const std::string& name, std::string_view text);
  static const Appearance& BuiltIn();

  /// REQUIRES of all below: the built-in table has what is asked for.
  const Surface& surface(Material material) const { return surfaces_.at(material); }
  const Lamp& lamp(const std::string& name) const { return lamps_.at(name); }
  float Number(const std::string& name) const;
  glm::vec3 Colour(const std::string& name) const;
  glm::vec4 ColourAndOpacity(const std::string& name) const;
  /// The numbers of the row "skin NAME".
  const std::vector<float>& Skin(std::string_view name) const;
  /// What has numbers and no word in front of its name as constants of GLSL: "const vec3 sky_color
  /// = vec3(...);". A compiler folds them, so a number in the table costs no more than one in a
  /// shader.
  const std::string& constants() const { return constants_; }

 private:
  explicit Appearance(NumberTable numbers);

  NumberTable numbers_;
  std::map<Material, Surface> surfaces_;
  std::map<std::string, Lamp> lamps_;
  std::string constants_;
};

}  // namespace fsm
