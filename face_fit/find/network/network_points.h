#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "fsm/base/side.h"

namespace facefit {

/// A point of the landmark network, by its number in MediaPipe's face mesh
/// (mediapipe/modules/face_geometry/data/canonical_face_model_uv_visualization.png).
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

template <std::size_t n>
using Group = std::array<PointIndex, n>;
inline constexpr fsm::Sided<Group<3>> kCheeks{{50, 205, 187}, {280, 425, 411}},
    kBrowInner{{107, 66, 55}, {336, 296, 285}}, kBrowOuter{{70, 63, 46}, {300, 293, 276}};
/// Skin below an eye and beside it.
inline constexpr fsm::Sided<Group<4>> kBelowEye{{119, 118, 117, 101}, {348, 347, 346, 330}};
/// Along the fold of a smile, from the wing of the nose to beside the chin.
inline constexpr fsm::Sided<Group<5>> kSmileFold{{129, 203, 206, 216, 212},
                                                 {358, 423, 426, 436, 432}};
/// Skin without hair on most faces: cheeks, forehead and chin.
inline constexpr Group<7> kBareSkin{50, 280, 205, 425, 151, 9, 199};
/// Points that neither speech nor brows nor lids move much: the nose's bridge, both corners of both
/// eyes, temples, the sides of the face above the jaw.
inline constexpr Group<20> kStill{168, 6,   197, 195, 33,  133, 362, 263, 127, 356,
                                  234, 454, 162, 389, 139, 368, 34,  264, 143, 372};
}  // namespace point

std::span<const PointIndex> PointsForFit();   ///< those the fit uses
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
