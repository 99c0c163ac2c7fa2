#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <span>

#include "fsm/head/anatomy.h"
#include "fsm/head/cage.h"
#include "fsm/head/features.h"
#include "fsm/head/subdivide.h"
#include "fsm/rig/eye_transform.h"
#include "fsm/rig/head_asset.h"

namespace fsm {

/// Returns the points of tables/landmarks.txt and those of eyes and ears, at rest; `rest` begins
/// with the vertices of `fine`. Throws std::runtime_error naming file and line for a damaged table.
Landmarks NameLandmarks(const Cage& cage, const FineSkin& fine, std::span<const glm::vec3> rest,
                        const EyeAnatomy& eye, const Sided<EyeTransform>& eye_transforms,
                        const Features& features);

/// Returns the texture coordinates of a base head's point; see HeadSurface::uv.
glm::vec2 SkinUv(glm::vec3 p);

}  // namespace fsm
