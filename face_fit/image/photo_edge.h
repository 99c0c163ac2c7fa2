#pragma once

#include <array>

#include "fsm/base/side.h"

namespace facefit {

/// The left and the right edge of a photo, as its viewer sees them.
enum class PhotoEdge { kLeft, kRight };
inline constexpr std::array kPhotoEdges{PhotoEdge::kLeft, PhotoEdge::kRight};

/// A value for the left and for the right edge of a photo.
template <typename T>
using PerPhotoEdge = fsm::Sided<T, PhotoEdge>;

/// Returns the direction towards the edge, as a step of x.
constexpr float Outward(PhotoEdge side) { return side == PhotoEdge::kLeft ? -1.0F : 1.0F; }

}  // namespace facefit
