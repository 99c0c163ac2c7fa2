#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "fsm/render/coarse_mesh.h"
#include "fsm/rig/head.h"

namespace fsm {

/// Which shader variant a part needs. Each step makes its pixels noticeably slower to draw.
enum class SkinDetail : std::uint8_t {
  kPlain,    ///< the colour, or the photo, alone
  kCreased,  ///< and creases of expression
  kDetailed  ///< and grain from elsewhere, and pixels that are left out or mixed with those behind
};

/// A part as it is drawn.
struct DrawnPart {
  HeadTopology::Part part;  ///< indices as uploaded
  bool soft = false;        ///< mixed with what is behind it
  SkinDetail detail = SkinDetail::kDetailed;
};

struct DrawOrder {
  std::vector<DrawnPart> parts;
  std::vector<std::uint32_t> indices;
};

/// The triangles of a head in the order to draw them. Pixels found to be hidden cost nearly
/// nothing, so the hair before the ears comes first, then the face, then the hair behind it, each
/// from the front to the back of a head that looks at the viewer. That is the best order most of
/// the time; where it is not, only time is lost. What is mixed with what lies behind it comes after
/// that. `triangles`: all of the topology or fewer; `detail`: of every vertex.
DrawOrder OrderToDraw(const HeadTopology& topology, const HeadTriangles& triangles,
                      std::span<const glm::vec3> rest, std::span<const SkinDetail> detail);

/// Whether a head wears a photo in layers, from back to front with soft edges.
inline bool HasSoftLayers(const HeadTopology& topology) {
  return topology.textures.image && !topology.opacity.empty();
}

}  // namespace fsm
