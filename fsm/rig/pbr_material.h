#pragma once

#include <cstdint>
#include <glm/vec3.hpp>

namespace fsm {

/// How a part of somebody else's head takes light, as its file says. Colours are linear.
struct PbrMaterial {
  enum class Kind : std::uint8_t {
    kLit,  ///< metal and roughness, as in glTF 2.0
    kToon  ///< two colours, as in VRM's MToon
  };
  Kind kind = Kind::kLit;
  float metallic = 0, roughness = 1;
  glm::vec3 glow{0};   ///< its own light
  glm::vec3 shade{1};  ///< toon: the colour away from the light
  /// Toon: cosines of the angle to the light where the shade's colour ends and the own one begins.
  float shade_to = 0, light_from = 0;
  bool cut_out = false;  ///< what is transparent in the picture is left out
};

}  // namespace fsm
