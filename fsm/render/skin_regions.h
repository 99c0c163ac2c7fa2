#pragma once

#include <glm/vec4.hpp>
#include <vector>

#include "fsm/render/appearance.h"
#include "fsm/render/face_landmarks.h"
#include "fsm/render/skin_map.h"

namespace fsm {

/// Slowly varying properties of the skin, one element for each cell of a SkinMap.
struct SkinRegion {
  glm::vec4 tint{1.0f};  ///< factors on colour and on highlights
  float pores = 0;       ///< how strongly they show, 0..1
  float cracks = 0;      ///< strength of the lines of the lips, 0..1
};
std::vector<SkinRegion> PaintRegions(const SkinMap& map, const FaceLandmarks& landmarks,
                                     const Appearance& appearance);

}  // namespace fsm
