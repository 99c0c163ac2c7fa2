#include "fsm/head/face_channels.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "embedded/action_units.h"
#include "fsm/base/smooth_step.h"

namespace fsm {

const UnitTable& BuiltInUnits() {
  static const UnitTable units(Table("tables/action_units.txt", embedded::action_units()));
  return units;
}

std::vector<Channel> MouthChannels(const MouthAnatomy& mouth,
                                   std::span<const BakeWeights> weights) {
  std::vector<Channel> channels;
  for (std::uint16_t parameter = 0; parameter < kMouthParameters; ++parameter) {
    Channel& channel = channels.emplace_back();
    channel.drivers.push_back({{.kind = Drive::Kind::kMouth, .number = parameter}});
  }
  const float corner_x = mouth.corner().x;
  const auto add = [&](std::size_t parameter, std::size_t i, glm::vec3 by) {
    if (std::abs(by.x) + std::abs(by.y) + std::abs(by.z) < 1e-3f) return;
    channels[parameter].moves.push_back({static_cast<std::uint32_t>(i), by});
  };
  for (std::size_t i = 0; i < weights.size(); ++i) {
    const BakeWeights& vertex = weights[i];
    const float a = std::abs(vertex.skin.domain.x);
    const float line = mouth.LineY(std::min(a, corner_x));
    if (vertex.skin.free <= 0 || a > 56 || vertex.skin.domain.y > -14 || vertex.skin.domain.y < -84)
      continue;
    const float side_x = vertex.skin.domain.x < 0 ? -1.0f : 1.0f;

    // The corner's displacement grows along the lips, sideways nearly in proportion, upward as a
    // bow, and fades into the cheek.
    const float height = std::abs(vertex.skin.domain.y - line);
    const float beside = SmoothStep(56, corner_x, a) * SmoothStep(24, 0, height) * vertex.skin.free;
    const float along_lip = std::min(1.0f, a / corner_x);
    const float corner = beside * std::pow(along_lip, 1.3f);
    add(kCornerX, i, {side_x * corner, 0, 0});
    add(kCornerY, i, {0, beside * std::pow(along_lip, 2.2f), 0});
    add(kCornerZ, i, {0, 0, corner});

    // The four rings of the lips move fully at the median and not at the corner.
    if (a >= corner_x || vertex.lip_weight == 0) continue;
    const bool upper = vertex.lip_weight > 0;
    const float along = 1 - (a / corner_x) * (a / corner_x);
    const float quarter = 4 * (a / corner_x) * (1 - a / corner_x);
    const float border = std::abs(mouth.BorderY(upper ? Lip::kUpper : Lip::kLower, a));
    const float share = std::min(1.0f, height / std::max(border, 0.5f));
    const float hold = std::abs(vertex.lip_weight);
    const float outer = share * hold;
    const float inner = (1 - share) * hold;
    add(upper ? kUpperOuterY : kLowerOuterY, i, {0, outer * along, 0});
    add(upper ? kUpperOuterZ : kLowerOuterZ, i, {0, 0, outer * along});
    add(upper ? kUpperInnerY : kLowerInnerY, i, {0, inner * along, 0});
    add(upper ? kUpperInnerZ : kLowerInnerZ, i, {0, 0, inner * along});
    add(upper ? kUpperOuterFullness : kLowerOuterFullness, i, {0, outer * quarter, 0});
    add(upper ? kUpperInnerFullness : kLowerInnerFullness, i, {0, inner * quarter, 0});
  }
  return channels;
}

LidRig BakeLids(const EyeAnatomy& eye, const Sided<EyeTransform>& eyes,
                std::span<const glm::vec3> rest, std::span<const BakeWeights> weights) {
  constexpr float kOnBall = 12.05f;  // mm; closer than that is the fold behind the lids
  LidRig rig;
  rig.eyes = eyes;
  rig.cornea_centre = eye.CorneaCentre();
  for (const Side side : kSides) {
    rig.ball[side] = eye.CentreOf(side) + eyes[side].shift;
  }
  float widest = 0;
  for (float x = eye.inner_x(); x < eye.outer_x(); x += 1) {
    widest = std::max(widest, eye.UpperY(x) - eye.LowerY(x));
  }
  for (std::size_t i = 0; i < weights.size(); ++i) {
    const BakeWeights& vertex = weights[i];
    if (!vertex.eye) continue;
    const float x = std::clamp(std::abs(vertex.skin.domain.x), eye.inner_x(), eye.outer_x());
    const float upper = eye.UpperAngle(x);
    const float lower = eye.LowerAngle(x);
    const Side side = *vertex.eye;
    const EyeTransform& transform = eyes[side];
    const EyeTransform back{.roll = -transform.roll, .size = 1 / transform.size};
    const glm::vec3 from_ball = back.Rotated(rest[i] - rig.ball[side]);
    rig.vertices.push_back(
        {.vertex = static_cast<std::uint32_t>(i),
         .side = side,
         .point = {.upper = vertex.lid_upper,
                   .lower = vertex.lid_lower,
                   .upper_angle = upper,
                   .lower_angle = lower,
                   .meet_angle = eye.MeetAngle(x),
                   .opening = (eye.UpperY(x) - eye.LowerY(x)) / widest,
                   .y = from_ball.y,
                   .z = from_ball.z + eye.centre().z - eye.LidAxisZ(x)},
         .is_lid = glm::length(rest[i] - rig.ball[side]) > transform.size * kOnBall});
  }
  return rig;
}

TeethRig BakeTeeth(const ToothArch& upper, const ToothArch& lower, std::span<const glm::vec3> rest,
                   std::span<const BakeWeights> weights) {
  constexpr float kMin = 1.3f;  // the crowns protrude from the parabola by about 0.9
  TeethRig rig{.upper = upper, .lower = lower, .contacts = {}};
  for (std::size_t i = 0; i < weights.size(); ++i) {
    if (!weights[i].by_teeth) continue;
    const glm::vec3 p = rest[i];
    rig.contacts.push_back({static_cast<std::uint32_t>(i),
                            std::min(kMin, p.z - step::ArchZ(upper, p.x)),
                            std::min(kMin, p.z - step::ArchZ(lower, p.x))});
  }
  return rig;
}

LipRig BakeLips(std::span<const BakeWeights> weights) {
  LipRig rig;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    const BakeWeights& vertex = weights[i];
    if (vertex.lip_column < 0 || vertex.lip_weight == 0) continue;
    rig.followers.push_back({static_cast<std::uint32_t>(i),
                             static_cast<std::uint32_t>(vertex.lip_column), vertex.lip_weight});
  }
  return rig;
}

}  // namespace fsm
