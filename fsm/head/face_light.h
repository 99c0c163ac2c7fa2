#pragma once

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <span>

namespace fsm {

/// Brightness on the screen (sRGB, 0..1), a little above 0 so that it can be divided by.
float ScreenBrightness(glm::vec3 screen);

/// Linear light of what a screen shows, nearly its square.
template <typename Colour>
Colour FromScreen(Colour screen) {
  return screen * screen;
}

/// How a photo's light falls on skin, by the direction the skin faces: a part that comes from
/// everywhere and one that grows along one direction (spherical harmonics up to the first order),
/// fitted to what the photo shows of a face. Beards, brows and shine are left out by the fit.
class FaceLight {
 public:
  struct Patch {
    glm::vec3 normal;  ///< unit
    glm::vec3 screen;  ///< what the photo shows of it, 0..1
  };
  /// Without patches all directions are lit alike.
  explicit FaceLight(std::span<const Patch> skin);

  /// Brightness on the screen of usual skin that faces so; at least a tenth.
  float On(glm::vec3 normal) const;

  /// The mean of what was taken for skin, on the screen.
  glm::vec3 skin() const { return skin_; }
  /// Light on a normal n: dot(xyz, n) + w.
  glm::vec4 coefficients() const { return light_; }

 private:
  glm::vec4 light_{0, 0, 0, 0.25f};
  glm::vec3 skin_{0.5f};
};

}  // namespace fsm
