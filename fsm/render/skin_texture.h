#pragma once

#include <glm/vec4.hpp>

#include "fsm/image/image.h"
#include "fsm/render/face_landmarks.h"
#include "fsm/rig/head.h"

namespace fsm {

class Appearance;

/// The look of skin at a finer scale than the vertices: two pictures of kSide x kSide texels over
/// HeadSurface::uv, the first row at v = 0.
struct SkinTexture {
  static constexpr int kSide = 1024;
  static constexpr float kTexelsPerMm = 3.3f;  ///< approximate, on the front of the face
  /// Factors on the surface's colour (rgb) and on its highlights (a), 128 = 1.
  Image tint;
  /// Slopes in the directions of growing u and v about 128: of pores and lines (rg, 127 = 0.5), and
  /// of the creases of expression (ba, 127 = 1).
  Image relief;
};

/// Paints the skin of a head: blotches, pores, freckles, vessels, shadows of the lids, lines of the
/// lips and creases, as the rows "skin" of the table say. The same head and table give the same
/// bytes. `rest`: vertices of the neutral state. It takes a few tens of milliseconds on two
/// threads: the caller's and one that ends before it returns.
SkinTexture PaintSkin(const HeadSurface& surface, const HeadVertices& rest,
                      const FaceLandmarks& landmarks, const Appearance& appearance);

}  // namespace fsm
