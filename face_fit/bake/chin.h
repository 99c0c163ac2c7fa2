#pragma once

#include <cmath>
#include <glm/vec3.hpp>

#include "face_fit/fit/fitted_head.h"
#include "face_fit/tables/photo_look.h"

namespace facefit {

/// The chin of the fitted head and the regions around it, head's frame.
class Chin {
 public:
  explicit Chin(const FittedHead& fitted) : position_(fitted.PositionOf(point::kChin)) {}
  float height() const { return position_.y; }
  /// Returns the height below which the photo's neck replaces the skin.
  float SkinBottom() const { return position_.y - PhotoLook().chin.skin_goes_on_mm; }
  /// Returns 1 well below the chin, 0 above it.
  float BelowShare(glm::vec3 p) const {
    return (position_.y + PhotoLook().chin.below_it_mm).Ramp(p.y);
  }
  /// Returns 1 below the chin, behind which the neck lies, 0 where skin continues to neck, ear and
  /// hair.
  float BeforeNeckShare(glm::vec3 p) const {
    return BelowShare(p) * PhotoLook().chin.before_neck_mm.Ramp(std::abs(p.x));
  }

 private:
  glm::vec3 position_;
};

}  // namespace facefit
