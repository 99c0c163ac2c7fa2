#pragma once

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <span>

namespace fsm {

/// Returns the screen brightness of a colour (sRGB, 0..1), slightly above 0 to allow division.
float ScreenBrightness(glm::vec3 screen);

/// Converts screen colour to linear light with an exponent of 2, close to sRGB's curve.
template <typename Colour>
Colour FromScreen(Colour screen) {
  return screen * screen;
}

/// The light of a photo on skin as a function of the skin's normal: an ambient part and one that
/// grows along one direction (spherical harmonics up to the first order), fitted to the colours of
/// a face. The fit leaves out beards, brows and highlights.
class FaceLight {
 public:
  struct Patch {
    glm::vec3 normal;  ///< unit length
    glm::vec3 screen;  ///< the patch's screen colour in the photo, 0..1
  };
  /// Without patches all directions get the same light.
  explicit FaceLight(std::span<const Patch> skin);

  /// Returns the screen brightness of typical skin with this normal; at least 0.1.
  float On(glm::vec3 normal) const;

  /// Returns the mean screen colour of the patches that count as skin.
  glm::vec3 skin() const { return skin_; }
  /// Light on a normal n: dot(xyz, n) + w.
  glm::vec4 coefficients() const { return light_; }

 private:
  glm::vec4 light_{0, 0, 0, 0.25f};
  glm::vec3 skin_{0.5f};
};

}  // namespace fsm
