#pragma once

#include <cstdint>
#include <vector>

#include "face_fit/find/figure/matte.h"
#include "face_fit/fit/fitted_head.h"
#include "fsm/head/photo_head.h"

namespace facefit {

/// The mesh that carries hair, neck and clothes.
struct Sheet {
  std::vector<fsm::PhotoHead::SheetVertex> vertices;
  std::vector<std::uint32_t> triangles;  ///< from back to front
  float skin_bottom_y;                   ///< PhotoHead::skin_bottom_y
};
/// Makes a sheet that lies just behind the face and recedes gently to the outline of the figure.
/// `pose`: projects to pixels of the figure.
Sheet MakeSheet(const FittedHead& fitted, const CameraPose& pose, const FigureCutout& figure);

}  // namespace facefit
