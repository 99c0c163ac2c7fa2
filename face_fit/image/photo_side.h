#pragma once

#include <array>

#include "fsm/base/side.h"

namespace facefit {

/// The left and the right edge of a photo, as its viewer sees them.
enum class PhotoSide { kLeft, kRight };
inline constexpr std::array kPhotoSides{PhotoSide::kLeft, PhotoSide::kRight};

/// A value for the left and for the right edge of a photo.
template <typename T>
using PerSide = fsm::Sided<T, PhotoSide>;

/// Returns the direction towards the edge, as a step of x.
constexpr float Outward(PhotoSide side) { return side == PhotoSide::kLeft ? -1.0F : 1.0F; }

}  // namespace facefit
