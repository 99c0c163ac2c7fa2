#pragma once

#include <optional>
#include <vector>

#include "fsm/render/eye_finder.h"
#include "fsm/render/face_landmarks.h"
#include "fsm/render/mouth_finder.h"
#include "fsm/render/shadow_finder.h"

namespace fsm {

/// What drawing measures on a head: the finders, which measure every frame, and what is measured
/// once, at rest.
struct HeadMeasures {
  HeadMeasures() = default;
  /// REQUIRES: `rest` and `landmarks`, if there are any, belong to `head`.
  HeadMeasures(const Head& head, const HeadVertices& rest,
               const std::optional<FaceLandmarks>& landmarks);

  /// Returns the vertices that the finders read.
  std::vector<std::uint32_t> Vertices() const;

  EyeFinder eyes;
  ShadowFinder shadows;
  MouthFinder mouth;
  Sided<MeasuredEye> resting_eyes;  ///< REQUIRES: eyes.found()
  /// The photo's resolution on the head as seen from the front; 0 without a photo.
  float photo_texels_per_mm = 0;
  std::optional<float> chin_y;  ///< height of the chin's lowest point, millimetres
};

}  // namespace fsm
