#pragma once

#include <glm/vec3.hpp>

namespace facefit {

/// The reflection of a flash by the back of an eye. Colours are 0..255.
class RedEye {
 public:
  /// `skin_colour`: of the skin below the eye.
  explicit RedEye(glm::vec3 skin_colour) : skin_colour_(skin_colour) {}
  /// Returns the likelihood, 0..1, that a colour in an iris is such a reflection: much redder than
  /// the skin, about as bright, and with as much blue relative to green. Brown irises have less
  /// blue or are darker.
  float Likelihood(glm::vec3 colour) const;
  /// Returns the colour with the red of a flash replaced by dark grey. `near`: the greatest
  /// likelihood at the pixel and close to it, because in a photo red runs over the edge of the
  /// pupil.
  glm::vec3 Without(glm::vec3 colour, float near) const;

 private:
  glm::vec3 skin_colour_;
};

}  // namespace facefit
