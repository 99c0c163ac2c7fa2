#pragma once

#include <cstdint>
#include <glm/vec4.hpp>
#include <vector>

#include "fsm/image/image.h"
#include "fsm/render/face_landmarks.h"
#include "fsm/rig/head.h"

namespace fsm {

class Appearance;

/// What skin looks like closer than a vertex: two pictures of kSide x kSide, their first row at v =
/// 0, over HeadTopology::uv.
struct SkinTexture {
  static constexpr int kSide = 1024;
  static constexpr float kTexelsPerMm = 3.3F;  ///< about, on the front of the face
  /// Factors on the surface's colour (rgb) and on its highlights (a), 128 = 1.
  Image tint;
  /// Slopes to growing u and growing v about 128: of pores and lines (rg, 127 = 0.5), of the
  /// creases of expression (ba, 127 = 1).
  Image relief;
};

/// Paints the skin of a head: blotches, pores, freckles, vessels, shadows of the lids, lines of the
/// lips, creases, all by the rows "skin" of the table. The same head and table give the same bytes.
/// `rest` are the vertices of the neutral state. Takes a few tens of milliseconds, of two threads:
/// the caller's and one that ends before it returns.
SkinTexture PaintSkin(const HeadTopology& topology, const HeadVertices& rest,
                      const FaceLandmarks& landmarks, const Appearance& appearance);

}  // namespace fsm
