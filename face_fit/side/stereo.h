#pragma once

#include <optional>
#include <vector>

#include "face_fit/fit/fitted_head.h"
#include "face_fit/image/raster.h"

namespace facefit {

/// The depth of a patch of skin that two photos show.
struct PatchDepth {
  glm::vec3 at_rest;  ///< of its middle on the base head
  float nearer_mm;    ///< to the front photo's camera than in the fit
};

/// A point of the fitted skin as the front photo shows it.
struct SkinSample {
  glm::vec3 in_camera, rest;  ///< in the camera's frame; on the base head
  glm::vec3 normal;           ///< head's frame, unit
  float brightness;
  float facing;  ///< cosine of the slant to the front photo's camera
};

/// Finds small patches of skin of the front photo in a photo from the side.
class StereoMatcher {
 public:
  /// `front_photo`: of the fit. `side_photo` outlives this object.
  StereoMatcher(const FittedHead& fitted, const fsm::Image& front_photo,
                const fsm::Image& side_photo);
  /// Refines `side_pose`, how the side photo was taken, until the patches that are found lie where
  /// the fitted head has them. Returns nothing if fewer than 25 are found.
  std::optional<CameraPose> RefinePose(CameraPose side_pose) const;
  /// Measures depth: of a turned face the network mostly reports what faces have in common.
  /// `side_pose`: as refined by RefinePose. Returns nothing if fewer than 25 patches are found.
  std::optional<std::vector<PatchDepth>> MeasureDepth(const CameraPose& side_pose) const;

 private:
  CameraPose front_pose_;
  const fsm::Image& side_photo_;
  Raster<std::optional<SkinSample>> samples_;
};

}  // namespace facefit
