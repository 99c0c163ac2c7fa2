#include "fsm/rig/pose.h"

#include <algorithm>
#include <cmath>
#include <glm/trigonometric.hpp>

namespace fsm {
namespace {

glm::mat3 TurnX(float angle) {
  const float c = std::cos(angle);
  const float s = std::sin(angle);
  return {1, 0, 0, 0, c, s, 0, -s, c};  // column-major
}
glm::mat3 TurnY(float angle) {
  const float c = std::cos(angle);
  const float s = std::sin(angle);
  return {c, 0, -s, 0, 1, 0, s, 0, c};
}
glm::mat3 TurnZ(float angle) {
  const float c = std::cos(angle);
  const float s = std::sin(angle);
  return {c, s, 0, -s, c, 0, 0, 0, 1};
}

// The lids follow the gaze: looking 25 degrees down lowers the upper lid by 6.3 mm and the lower by
// 1.7 mm, looking as far up raises them by 3.3 mm and 1.3 mm.
void FollowGaze(float down_degrees, UnitEffects::Lids& lids) {
  const float part = -down_degrees / 25;
  lids.upper_mm += part * (part < 0 ? 6.3f : 3.3f);
  lids.lower_mm += part * (part < 0 ? 1.7f : 1.3f);
}

}  // namespace

float Bound(float value, float least, float most) {
  return std::isfinite(value) ? std::clamp(value, least, most) : 0.0f;
}

glm::mat3 HeadTurn(const FaceState& state) {
  return TurnY(glm::radians(Bound(state.head_rotation[kToRight], -80, 80))) *
         TurnX(glm::radians(Bound(state.head_rotation[kDown], -60, 60))) *
         TurnZ(-glm::radians(Bound(state.head_rotation[kTilted], -50, 50)));
}

float HeadForward(const FaceState& state) { return Bound(state.head_forward, -30, 45); }

Pose MakePose(const FaceState& state, const UnitTable& table) {
  Pose pose{};
  pose.units = table.Combine(state);
  const UnitEffects effects = table.Effects(pose.units);
  // The mouth parameters are limited to what lips can do, in millimetres; the jaw is apart.
  for (std::size_t p = 0; p < kMouthParameters; ++p) pose.mouth[p] = Bound(state.mouth[p], -14, 14);
  // A mandible opens 25-30 degrees and slides about 1 mm forward for every three degrees.
  const float degrees = Bound(effects.jaw_degrees + Bound(state.mouth[kJawY], -30, 30), 0, 28);
  const float slide_mm = Bound(effects.jaw_slide_mm + Bound(state.mouth[kJawZ], -6, 10), -4, 12);
  pose.mouth[kJawY] = degrees - Bound(effects.jaw_degrees, 0, 28);
  pose.mouth[kJawZ] = slide_mm - Bound(effects.jaw_slide_mm, -4, 12);
  pose.jaw = {.open_rad = glm::radians(degrees),
              .slide_mm = slide_mm,
              .sway_mm = Bound(effects.jaw_sway_mm, -10, 10)};
  pose.seal = Bound(std::max(effects.seal, Bound(state.lip_seal, 0, 1)), 0, 1);
  pose.tongue_raise = Bound(effects.tongue_raise + Bound(state.tongue, 0, 1), 0, 1);
  pose.tongue_out_mm = Bound(effects.tongue_out_mm, 0, 30);

  for (const Side s : kSides) {
    const float down = Bound(state.gaze[s][kDown], -35, 35);
    const float right = Bound(state.gaze[s][kToRight], -45, 45);
    pose.eye[s] = EyeTo({down, right});
    pose.lids[s] = effects.lids[s];
    FollowGaze(down, pose.lids[s]);
    pose.lids[s].upper_mm = std::clamp(pose.lids[s].upper_mm, -11.0f, 4.0f);
    pose.lids[s].lower_mm = std::clamp(pose.lids[s].lower_mm, -3.0f, 4.0f);
    const float open = 1 - std::min(1.0f, effects.lids[s].close);
    pose.blink[s] = open * Bound(state.blink[s], 0, 1);
    pose.lids[s].close = 1 - open + pose.blink[s];
  }
  pose.head = HeadTurn(state);
  pose.head_forward_mm = HeadForward(state);
  return pose;
}

EyeAngles GazeOf(const glm::mat3& eye) {
  const glm::vec3 ahead = eye[2];
  return {-glm::degrees(std::asin(std::clamp(ahead.y, -1.0F, 1.0F))),
          glm::degrees(std::atan2(ahead.x, ahead.z))};
}

glm::mat3 EyeTo(const EyeAngles& gaze) {
  // The eye turns up first, then sideways; the third column of the matrix is the line of sight.
  return TurnY(glm::radians(gaze[kToRight])) * TurnX(glm::radians(gaze[kDown]));
}

}  // namespace fsm
