#include "face_fit/find/network/network_points.h"

namespace facefit {
namespace {

constexpr PointIndex kUpperOuter[] = {185, 40, 39, 37, 0, 267, 269, 270, 409};
constexpr PointIndex kLowerOuter[] = {146, 91, 181, 84, 17, 314, 405, 321, 375};
constexpr PointIndex kUpperInner[] = {78, 191, 80, 81, 82, 13, 312, 311, 310, 415, 308};
constexpr PointIndex kLowerInner[] = {95, 88, 178, 87, 14, 317, 402, 318, 324};
constexpr PointIndex kRightEye[] = {33,  246, 161, 160, 159, 158, 157, 173,
                                    133, 155, 154, 153, 145, 144, 163, 7};
constexpr PointIndex kLeftEye[] = {263, 466, 388, 387, 386, 385, 384, 398,
                                   362, 382, 381, 380, 374, 373, 390, 249};
constexpr PointIndex kFit[] = {
    // outline from the forehead round by the person's left
    10, 338, 297, 332, 284, 251, 389, 356, 454, 323, 361, 288, 397, 365, 379, 378, 400, 377, 152,
    148, 176, 149, 150, 136, 172, 58, 132, 93, 234, 127, 162, 21, 54, 103, 67, 109,
    // lips, outer and inner border
    61, 185, 40, 39, 37, 0, 267, 269, 270, 409, 291, 146, 91, 181, 84, 17, 314, 405, 321, 375, 78,
    191, 80, 81, 82, 13, 312, 311, 310, 415, 308, 95, 88, 178, 87, 14, 317, 402, 318, 324,
    // eyes
    33, 246, 161, 160, 159, 158, 157, 173, 133, 155, 154, 153, 145, 144, 163, 7, 263, 466, 388, 387,
    386, 385, 384, 398, 362, 382, 381, 380, 374, 373, 390, 249,
    // brows
    70, 63, 105, 66, 107, 46, 53, 52, 65, 55, 300, 293, 334, 296, 336, 276, 283, 282, 295, 285,
    // nose
    168, 6, 197, 195, 5, 4, 1, 2, 129, 358, 98, 327, 64, 294, 48, 278, 115, 344,
    // forehead, cheeks, chin
    151, 9, 8, 108, 337, 104, 333, 50, 280, 205, 425, 116, 345, 187, 411, 207, 427, 199, 18, 200,
    192, 416, 214, 434};

}  // namespace

std::span<const PointIndex> PointsForFit() { return kFit; }
std::span<const PointIndex> UpperOuterLip() { return kUpperOuter; }
std::span<const PointIndex> LowerOuterLip() { return kLowerOuter; }
std::span<const PointIndex> UpperInnerLip() { return kUpperInner; }
std::span<const PointIndex> LowerInnerLip() { return kLowerInner; }
std::span<const PointIndex> EyeOutline(fsm::Side side) {
  return side == fsm::Side::kRight ? kRightEye : kLeftEye;
}

}  // namespace facefit
