#pragma once

#include <cstdint>
#include <glm/vec3.hpp>

namespace fsm {

/// The material of a part of a head read from a file. Colours are linear.
struct PbrMaterial {
  enum class Kind : std::uint8_t {
    kLit,  ///< metallic-roughness model, as in glTF 2.0
    kToon  ///< two colours, as in VRM's MToon
  };
  Kind kind = Kind::kLit;
  float metallic = 0, roughness = 1;
  glm::vec3 emissive{0};      ///< emitted light
  glm::vec3 shade_colour{1};  ///< toon: colour of the side that faces away from the light
  /// Toon: cosines of the angle to the light where the shade colour ends and the lit colour begins.
  float shade_to = 0, light_from = 0;
  bool cut_out = false;  ///< alpha test: transparent pixels of the picture are discarded
};

}  // namespace fsm
