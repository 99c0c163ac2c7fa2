#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "fsm/base/side.h"

namespace facefit {

/// A point of the landmark network, by its number in MediaPipe's face mesh
/// (mediapipe/modules/face_geometry/data/canonical_face_model_uv_visualization.png).
using PointIndex = std::size_t;
inline constexpr PointIndex kNetworkPoints = 468;
/// A value for each of the network's points.
template <typename T>
using PerPoint = std::array<T, kNetworkPoints>;

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
inline constexpr Group<2> kMouthCorners{kMouthRight, kMouthLeft},
    kInnerMouthCorners{kInnerMouthRight, kInnerMouthLeft};
inline constexpr fsm::Sided<Group<3>> kCheeks{{50, 205, 187}, {280, 425, 411}},
    kBrowInner{{107, 66, 55}, {336, 296, 285}}, kBrowOuter{{70, 63, 46}, {300, 293, 276}};
/// Skin below and beside an eye.
inline constexpr fsm::Sided<Group<4>> kBelowEye{{119, 118, 117, 101}, {348, 347, 346, 330}};
/// Along the fold of a smile, from the wing of the nose to beside the chin.
inline constexpr fsm::Sided<Group<5>> kSmileFold{{129, 203, 206, 216, 212},
                                                 {358, 423, 426, 436, 432}};
/// Skin without hair on most faces: cheeks, forehead and chin.
inline constexpr Group<7> kBareSkin{50, 280, 205, 425, 151, 9, 199};
/// Points that neither speech nor brows nor lids move much: bridge of the nose, corners of the
/// eyes, temples, sides of the face above the jaw.
inline constexpr Group<20> kRigid{168, 6,   197, 195, 33,  133, 362, 263, 127, 356,
                                  234, 454, 162, 389, 139, 368, 34,  264, 143, 372};
/// Borders of the lips from the person's right to left, without the corners.
inline constexpr Group<9> kUpperOuterLip{185, 40, 39, 37, 0, 267, 269, 270, 409};
inline constexpr Group<9> kLowerOuterLip{146, 91, 181, 84, 17, 314, 405, 321, 375};
inline constexpr Group<9> kUpperInnerLip{191, 80, 81, 82, 13, 312, 311, 310, 415};
inline constexpr Group<9> kLowerInnerLip{95, 88, 178, 87, 14, 317, 402, 318, 324};
/// An eye's outline, closed: the outer corner, seven points of the upper lid, the inner corner, and
/// seven points of the lower lid on the way back.
inline constexpr fsm::Sided<Group<16>> kEyeOutline{
    {33, 246, 161, 160, 159, 158, 157, 173, 133, 155, 154, 153, 145, 144, 163, 7},
    {263, 466, 388, 387, 386, 385, 384, 398, 362, 382, 381, 380, 374, 373, 390, 249}};
/// The closed outline of the face, from the forehead round by the person's left.
inline constexpr Group<36> kFaceOutline{10,  338, 297, 332, 284, 251, 389, 356, 454, 323, 361, 288,
                                        397, 365, 379, 378, 400, 377, 152, 148, 176, 149, 150, 136,
                                        172, 58,  132, 93,  234, 127, 162, 21,  54,  103, 67,  109};
inline constexpr fsm::Sided<Group<10>> kBrow{{70, 63, 105, 66, 107, 46, 53, 52, 65, 55},
                                             {300, 293, 334, 296, 336, 276, 283, 282, 295, 285}};
inline constexpr Group<18> kNose{168, 6,  197, 195, 5,   4,  1,   2,   129,
                                 358, 98, 327, 64,  294, 48, 278, 115, 344};
/// Forehead, cheeks and chin within the outline.
inline constexpr Group<24> kWithinOutline{151, 9,   8,   108, 337, 104, 333, 50,
                                          280, 205, 425, 116, 345, 187, 411, 207,
                                          427, 199, 18,  200, 192, 416, 214, 434};

template <std::size_t... n>
constexpr auto Joined(const Group<n>&... groups) {
  Group<(n + ...)> all{};
  auto to = all.begin();
  ((to = std::ranges::copy(groups, to).out), ...);
  return all;
}
/// The points that the network places well on any face.
inline constexpr auto kReliable = Joined(
    kFaceOutline, Group<1>{kMouthRight}, kUpperOuterLip, Group<1>{kMouthLeft}, kLowerOuterLip,
    Group<1>{kInnerMouthRight}, kUpperInnerLip, Group<1>{kInnerMouthLeft}, kLowerInnerLip,
    kEyeOutline.right, kEyeOutline.left, kBrow.right, kBrow.left, kNose, kWithinOutline);
static_assert(std::ranges::all_of(kReliable, [](PointIndex i) {
  return i < kNetworkPoints && std::ranges::count(kReliable, i) == 1;
}));
}  // namespace point

/// Distance of the outer corners of the eyes of the built-in head (Farkas 1994: 91.2 and 87.8 for
/// men and women).
inline constexpr float kEyesApartMm = 90;

inline bool Contains(std::span<const PointIndex> list, PointIndex i) {
  return std::ranges::find(list, i) != list.end();
}

/// Returns whether a point lies on the inner lips, corners included.
inline bool OnInnerLips(PointIndex i) {
  return Contains(point::kUpperInnerLip, i) || Contains(point::kLowerInnerLip, i) ||
         Contains(point::kInnerMouthCorners, i);
}

/// Returns the border of a lip from corner to corner.
inline std::vector<PointIndex> WithCorners(std::span<const PointIndex> lip,
                                           const point::Group<2>& corners) {
  std::vector<PointIndex> border{corners[0]};
  border.insert(border.end(), lip.begin(), lip.end());
  border.push_back(corners[1]);
  return border;
}

/// Indices into point::kEyeOutline: the corners and the middles of the lids.
inline constexpr std::size_t kOuterCorner = 0, kUpperMiddle = 4, kInnerCorner = 8,
                             kLowerMiddle = 12;

}  // namespace facefit
