#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "fsm/render/coarse_mesh.h"
#include "fsm/rig/head.h"

namespace fsm {

/// The shader variant that a part needs. Each step makes its pixels noticeably slower to draw.
enum class SkinDetail : std::uint8_t {
  kPlain,    ///< colour or photo only
  kCreased,  ///< adds creases of expression
  kDetailed  ///< adds grain from elsewhere, and discarded or blended pixels
};

/// A part of the head as it is drawn.
struct DrawnPart {
  HeadSurface::Part part;  ///< indices into the uploaded buffer
  bool blended = false;    ///< drawn over what lies behind it
  SkinDetail detail = SkinDetail::kDetailed;
};

struct DrawOrder {
  std::vector<DrawnPart> parts;
  std::vector<std::uint32_t> indices;
};

/// Orders a head's triangles for drawing. Hidden pixels cost almost nothing, so hair before the
/// ears comes first, then the face, then the hair behind it, each from front to back of a head that
/// looks at the viewer. That is the best order most of the time; where it is not, only time is
/// lost. Blended triangles come after the face; no head has both these and hair behind the ears,
/// since only one with a photo has blended ones, and it has no hair. `triangles`: all of the
/// surface or fewer; `detail`: per vertex.
DrawOrder OrderToDraw(const HeadSurface& surface, const HeadTriangles& triangles,
                      std::span<const glm::vec3> rest, std::span<const SkinDetail> detail);

/// Tells whether a head wears a photo in layers with soft edges, blended from back to front.
inline bool HasBlendedLayers(const HeadSurface& surface) {
  return surface.textures.base_colour && !surface.opacity.empty();
}

}  // namespace fsm
