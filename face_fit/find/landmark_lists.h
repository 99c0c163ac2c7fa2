#pragma once

#include <cstddef>
#include <span>

namespace facefit {

/// Points of the network by what they lie on; numbers of MediaPipe's face mesh.
std::span<const int> FitPoints();      ///< those the fit uses
std::span<const int> UpperOuterLip();  ///< without corners
std::span<const int> LowerOuterLip();  ///< likewise
std::span<const int> UpperInnerLip();  ///< from the person's right to left, corners included
std::span<const int> LowerInnerLip();  ///< likewise, without corners

/// An eye's outline, closed: the outer corner, seven points of the upper lid, the inner corner, and
/// seven points of the lower lid on the way back. `side`: 0 = the person's right.
std::span<const int> EyeOutline(int side);
inline constexpr std::size_t kInnerCorner = 8;

}  // namespace facefit
