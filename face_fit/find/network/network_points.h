#pragma once

#include <cstddef>
#include <span>

#include "fsm/base/side.h"

namespace facefit {

/// A point of the landmark network, by its number in MediaPipe's face mesh.
using PointIndex = std::size_t;
inline constexpr PointIndex kNetworkPoints = 468;
inline constexpr PointIndex kNoPoint = kNetworkPoints;

/// The points that have names; right and left are the person's.
namespace point {
inline constexpr PointIndex kForehead = 10, kNasion = 168, kNoseBridge = 6, kNoseTip = 1,
                            kNoseBottom = 2, kNoseRight = 129, kNoseLeft = 358, kChin = 152,
                            kBrowRight = 105, kBrowLeft = 334, kCheekRight = 234, kCheekLeft = 454,
                            kJawRight = 172, kJawLeft = 397;
inline constexpr PointIndex kEyeOuterRight = 33, kEyeOuterLeft = 263, kEyeInnerRight = 133,
                            kEyeInnerLeft = 362, kEyeTopRight = 159, kEyeTopLeft = 386,
                            kEyeBottomRight = 145, kEyeBottomLeft = 374;
/// Corners and middles of the outer and the inner border of the lips.
inline constexpr PointIndex kMouthRight = 61, kMouthLeft = 291, kLipTop = 0, kLipBottom = 17,
                            kInnerMouthRight = 78, kInnerMouthLeft = 308, kInnerLipTop = 13,
                            kInnerLipBottom = 14;
}  // namespace point

std::span<const PointIndex> FitPoints();      ///< those the fit uses
std::span<const PointIndex> UpperOuterLip();  ///< from the person's right to left, without corners
std::span<const PointIndex> LowerOuterLip();  ///< likewise
std::span<const PointIndex> UpperInnerLip();  ///< likewise, corners included
std::span<const PointIndex> LowerInnerLip();  ///< likewise, without corners

/// An eye's outline, closed: the outer corner, seven points of the upper lid, the inner corner, and
/// seven points of the lower lid on the way back.
std::span<const PointIndex> EyeOutline(fsm::Side side);
/// Places in that list: corners and the middles of the lids.
inline constexpr std::size_t kOuterCorner = 0, kUpperMiddle = 4, kInnerCorner = 8,
                             kLowerMiddle = 12;

}  // namespace facefit
