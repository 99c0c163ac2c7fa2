#pragma once

#include <array>

#include "fsm/base/side.h"

namespace facefit {

/// The left and the right edge of a photo, as its viewer sees them.
enum class SideEdge { kLeft, kRight };
inline constexpr std::array kSideEdges{SideEdge::kLeft, SideEdge::kRight};

/// A value for the left and for the right edge of a photo.
template <typename T>
using PerSideEdge = fsm::Sided<T, SideEdge>;

/// Returns the direction towards the edge, as a step of x.
constexpr float Outward(SideEdge side) { return side == SideEdge::kLeft ? -1.0F : 1.0F; }

}  // namespace facefit
