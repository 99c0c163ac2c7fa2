#include "fsm/rig/pose.h"

#include <algorithm>
#include <cmath>
#include <glm/trigonometric.hpp>

#include "fsm/base/range.h"

namespace fsm {
namespace {

glm::mat3 RotationX(float angle) {
  const float c = std::cos(angle);
  const float s = std::sin(angle);
  return {1, 0, 0, 0, c, s, 0, -s, c};  // column-major
}
glm::mat3 RotationY(float angle) {
  const float c = std::cos(angle);
  const float s = std::sin(angle);
  return {c, 0, -s, 0, 1, 0, s, 0, c};
}
glm::mat3 RotationZ(float angle) {
  const float c = std::cos(angle);
  const float s = std::sin(angle);
  return {c, s, 0, -s, c, 0, 0, 0, 1};
}

// The lids follow the gaze: looking 25 degrees down lowers the upper lid by 6.3 mm and the lower by
// 1.7 mm, looking as far up raises them by 3.3 mm and 1.3 mm.
constexpr float kGazeOfLids = 25;  // degrees
constexpr float kUpperLidDown = 6.3f, kUpperLidUp = 3.3f;
constexpr float kLowerLidDown = 1.7f, kLowerLidUp = 1.3f;

// What people can do; ours but for the jaw: a mandible opens 25-30 degrees and slides about 1 mm
// forward for every three degrees.
constexpr Range kHeadRightRange{-80, 80}, kHeadDownRange{-60, 60},
    kHeadTiltRange{-50, 50};                                        // degrees
constexpr Range kHeadForwardRange{-30, 45};                         // mm
constexpr Range kGazeDownRange{-35, 35}, kGazeRightRange{-45, 45};  // degrees
constexpr Range kMouthRange{-14, 14};                               // mm
constexpr Range kJawOpenRange{0, 28}, kJawAskedRange{-30, 30};      // degrees
constexpr Range kJawSlideRange{-4, 12}, kSlideAskedRange{-6, 10}, kJawSwayRange{-10, 10};  // mm
constexpr Range kTongueOutRange{0, 30};                                                    // mm
constexpr Range kUpperLidRange{-11, 4}, kLowerLidRange{-3, 4};  // mm above the rest

float Within(float value, const Range& range) { return Bound(value, range.from, range.to); }

void FollowGaze(float down_degrees, UnitEffects::Lids& lids) {
  const float share = -down_degrees / kGazeOfLids;
  lids.upper_mm += share * (share < 0 ? kUpperLidDown : kUpperLidUp);
  lids.lower_mm += share * (share < 0 ? kLowerLidDown : kLowerLidUp);
}

}  // namespace

float Bound(float value, float min, float max) {
  return std::isfinite(value) ? std::clamp(value, min, max) : 0.0f;
}

glm::mat3 HeadRotation(const FaceState& state) {
  return RotationY(glm::radians(Within(state.head_rotation[kToRight], kHeadRightRange))) *
         RotationX(glm::radians(Within(state.head_rotation[kDown], kHeadDownRange))) *
         RotationZ(-glm::radians(Within(state.head_rotation[kTilted], kHeadTiltRange)));
}

float HeadForward(const FaceState& state) {
  return Within(state.head_forward_mm, kHeadForwardRange);
}

Pose MakePose(const FaceState& state, const UnitTable& units, const UnitCombiner& combiner) {
  Pose pose{};
  pose.au = combiner.ActingUnits(state);
  const UnitEffects effects = SumEffects(units, pose.au);
  for (std::size_t p = 0; p < kMouthParameters; ++p)
    pose.mouth[p] = Within(state.mouth[p], kMouthRange);
  const float degrees =
      Within(effects.jaw_degrees + Within(state.mouth[kJawY], kJawAskedRange), kJawOpenRange);
  const float slide_mm =
      Within(effects.jaw_slide_mm + Within(state.mouth[kJawZ], kSlideAskedRange), kJawSlideRange);
  pose.mouth[kJawY] = degrees - Within(effects.jaw_degrees, kJawOpenRange);
  pose.mouth[kJawZ] = slide_mm - Within(effects.jaw_slide_mm, kJawSlideRange);
  pose.jaw = {.open_rad = glm::radians(degrees),
              .slide_mm = slide_mm,
              .sway_mm = Within(effects.jaw_sway_mm, kJawSwayRange)};
  pose.seal = Bound(std::max(effects.seal, Bound(state.seal, 0, 1)), 0, 1);
  pose.tongue_raise = Bound(effects.tongue_raise + Bound(state.tongue, 0, 1), 0, 1);
  pose.tongue_out_mm = Within(effects.tongue_out_mm, kTongueOutRange);

  for (const Side s : kSides) {
    const float down = Within(state.gaze[s][kDown], kGazeDownRange);
    const float right = Within(state.gaze[s][kToRight], kGazeRightRange);
    pose.eye[s] = EyeRotationOf({down, right});
    pose.lids[s] = effects.lids[s];
    FollowGaze(down, pose.lids[s]);
    pose.lids[s].upper_mm = kUpperLidRange.Clamp(pose.lids[s].upper_mm);
    pose.lids[s].lower_mm = kLowerLidRange.Clamp(pose.lids[s].lower_mm);
    const float open = 1 - std::min(1.0f, effects.lids[s].close);
    pose.blink[s] = open * Bound(state.blink[s], 0, 1);
    pose.lids[s].close = 1 - open + pose.blink[s];
  }
  pose.head = HeadRotation(state);
  pose.head_forward_mm = HeadForward(state);
  return pose;
}

EyeAngles GazeOf(const glm::mat3& eye) {
  const glm::vec3 ahead = eye[2];
  return {-glm::degrees(std::asin(std::clamp(ahead.y, -1.0f, 1.0f))),
          glm::degrees(std::atan2(ahead.x, ahead.z))};
}

glm::mat3 EyeRotationOf(const EyeAngles& gaze) {
  // The eye turns up first, then sideways; the third column of the matrix is the line of sight.
  return RotationY(glm::radians(gaze[kToRight])) * RotationX(glm::radians(gaze[kDown]));
}

}  // namespace fsm
