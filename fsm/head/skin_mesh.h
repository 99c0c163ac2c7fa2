#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "fsm/head/anatomy.h"
#include "fsm/head/face_surface.h"
#include "fsm/head/rig.h"

namespace fsm {

/// What later parts and the deformer must know about the skin.
struct SkinMap {
  /// Seam vertices, upper and lower, of every column of the mouth's slit, from the viewer's left to
  /// right, corners excluded.
  std::vector<std::pair<std::uint32_t, std::uint32_t>> seam;
  std::uint32_t corner_left = 0, corner_right = 0;  ///< the agent's
  std::uint32_t mid_column = 0;                     ///< index into `seam` of the median
  std::uint32_t vertex_count = 0;
};

/// Skin from crown to chest with slits for eyes and mouth, red of the lips, inner lid rims, mouth
/// bag and the garment: one grid of columns (crown to chest) and rows (round the head).
SkinMap BuildSkin(const FaceSurface& surface, const EyeAnatomy& eye, const MouthAnatomy& mouth,
                  HeadMesh& mesh);

}  // namespace fsm
