#include "fsm/head/deformer.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace fsm {

Deformer::Deformer(std::vector<glm::vec3> rest, std::vector<SkinWeights> flesh,
                   std::vector<std::pair<std::uint32_t, std::uint32_t>> seam,
                   const UnitTable& units, const EyeAnatomy& eye,
                   const std::array<EyeTransform, 2>& seats, const MouthAnatomy& mouth,
                   const TeethPlace& teeth)
    : rest_(std::move(rest)), flesh_(std::move(flesh)), seam_(std::move(seam)), seats_(seats) {
  MoveBy(units);
  AddMouthFields(mouth);
  upper_teeth_ = mouth.UpperTeeth().Moved(teeth);
  lower_teeth_ = mouth.LowerTeeth().Moved(teeth);
  for (std::size_t i = 0; i < rest_.size(); ++i) {
    if (!flesh_[i].by_teeth) continue;
    const glm::vec3 p = rest_[i];
    constexpr float kLeast = 1.3f;  // the crowns bulge out of the parabola by about 0.9
    touching_.push_back({static_cast<std::uint32_t>(i),
                         std::min(kLeast, p.z - upper_teeth_.At(p.x)),
                         std::min(kLeast, p.z - lower_teeth_.At(p.x))});
  }
  AddLids(eye);
  for (std::size_t i = 0; i < rest_.size(); ++i) {
    if (flesh_[i].jaw > 0.001f) jawed_.push_back(static_cast<std::uint32_t>(i));
    if (flesh_[i].lip_column >= 0 && flesh_[i].lip_weight != 0) {
      lipped_.push_back(static_cast<std::uint32_t>(i));
    }
  }
}

void Deformer::MoveBy(const UnitTable& units) {
  for (std::size_t side = 0; side < 2; ++side) {
    std::array<std::vector<glm::vec3>, kActionUnits> sums;
    for (const UnitTable::Field& field : units.fields()) {
      auto& sum = sums[static_cast<std::size_t>(field.unit)];
      sum.resize(rest_.size(), glm::vec3(0));
      for (std::size_t i = 0; i < rest_.size(); ++i) {
        sum[i] += UnitTable::Motion(field, flesh_[i], side == 0);
      }
    }
    for (std::size_t unit = 0; unit < kActionUnits; ++unit) {
      unit_fields_[side][unit].clear();
      for (std::size_t i = 0; i < sums[unit].size(); ++i) {
        const glm::vec3 d = sums[unit][i];
        if (d.x * d.x + d.y * d.y + d.z * d.z > 1e-6f) {
          unit_fields_[side][unit].push_back({static_cast<std::uint32_t>(i), d});
        }
      }
    }
  }
}

void Deformer::AddMouthFields(const MouthAnatomy& mouth) {
  const float corner_x = mouth.corner().x;
  const auto add = [&](std::size_t parameter, std::size_t i, glm::vec3 by) {
    if (std::abs(by.x) + std::abs(by.y) + std::abs(by.z) < 1e-3f) return;
    mouth_fields_[parameter].push_back({static_cast<std::uint32_t>(i), by});
  };
  for (std::size_t i = 0; i < rest_.size(); ++i) {
    const SkinWeights& f = flesh_[i];
    const float a = std::abs(f.domain.x);
    const float line = mouth.LineY(std::min(a, corner_x));
    if (f.free <= 0 || a > 56 || f.domain.y > -14 || f.domain.y < -84) continue;
    const float side_x = f.domain.x < 0 ? -1.0f : 1.0f;

    // The corner's field: linear along the lips, fading into the cheek.
    const float height = std::abs(f.domain.y - line);
    const float corner =
        (a < corner_x ? std::pow(a / corner_x, 1.3f) : SmoothStep(56, corner_x, a)) *
        SmoothStep(24, 0, height) * f.free;
    add(8, i, {side_x * corner, 0, 0});
    add(9, i, {0, corner, 0});
    add(10, i, {0, 0, corner});

    // The lips' four rings: full in the middle, nothing at the corner.
    if (a >= corner_x || f.lip_weight == 0) continue;
    const bool upper = f.lip_weight > 0;
    const float along = 1 - (a / corner_x) * (a / corner_x);
    const float quarter = 4 * (a / corner_x) * (1 - a / corner_x);
    const float border = std::abs(mouth.BorderY(upper ? 1 : -1, a));
    const float part = std::min(1.0f, height / std::max(border, 0.5f));
    const float hold = std::abs(f.lip_weight);
    const float outer = part * hold;
    const float inner = (1 - part) * hold;
    const std::size_t outer_y = upper ? 0 : 6;
    const std::size_t inner_y = upper ? 2 : 4;
    add(outer_y, i, {0, outer * along, 0});
    add(outer_y + 1, i, {0, 0, outer * along});
    add(inner_y, i, {0, inner * along, 0});
    add(inner_y + 1, i, {0, 0, inner * along});
    add(upper ? 13 : 15, i, {0, outer * quarter, 0});
    add(upper ? 14 : 16, i, {0, inner * quarter, 0});
  }
}

void Deformer::AddLids(const EyeAnatomy& eye) {
  const std::array<glm::vec3, 2> table = {eye.centre() * glm::vec3(-1, 1, 1), eye.centre()};
  for (std::size_t side = 0; side < 2; ++side) ball_[side] = table[side] + seats_[side].shift;
  cornea_ = eye.CorneaCentre();
  float widest = 0;
  for (float x = eye.inner_x(); x < eye.outer_x(); x += 1) {
    widest = std::max(widest, eye.UpperY(x) - eye.LowerY(x));
  }
  for (std::size_t i = 0; i < rest_.size(); ++i) {
    const SkinWeights& f = flesh_[i];
    if (f.eye == 0) continue;
    const float x = std::clamp(std::abs(f.domain.x), eye.inner_x(), eye.outer_x());
    const float upper = eye.UpperAngle(x);
    const float lower = eye.LowerAngle(x);
    const int side = f.eye > 0 ? 1 : 0;
    const EyeTransform& seat = seats_[static_cast<std::size_t>(side)];
    const EyeTransform back{.turn = -seat.turn, .size = 1 / seat.size};
    const glm::vec3 from_ball = back.Turned(rest_[i] - ball_[static_cast<std::size_t>(side)]);
    lids_.push_back({static_cast<std::uint32_t>(i), side, f.lid_upper, f.lid_lower, upper, lower,
                     eye.MeetAngle(x), (eye.UpperY(x) - eye.LowerY(x)) / widest, from_ball.y,
                     from_ball.z + eye.centre().z - eye.LidAxisZ(x)});
  }
}

void Deformer::MoveLids(const Pose& pose, glm::vec3* out) const {
  constexpr float kRadius = 13.35f;  // turns millimetres at the lid's edge into an angle
  for (const LidVertex& lid : lids_) {
    const UnitEffects::Lids& ask = pose.lids[static_cast<std::size_t>(lid.side)];
    const EyeTransform& seat = seats_[static_cast<std::size_t>(lid.side)];
    float upper = lid.upper_angle + lid.opening * (seat.upper_mm + ask.upper_mm) / kRadius;
    // A lower lid that is raised goes up nearly as far beside the middle, so that it stays a curve.
    const float raised = ask.lower_mm * (ask.lower_mm > 0 ? std::sqrt(lid.opening) : lid.opening);
    float lower = lid.lower_angle + (lid.opening * seat.lower_mm + raised) / kRadius;
    if (upper < lower) upper = lower = 0.5f * (upper + lower);
    upper += ask.close * (lid.meet_angle - upper);
    lower += ask.close * (lid.meet_angle - lower);
    const float turn =
        lid.upper * (upper - lid.upper_angle) + lid.lower * (lower - lid.lower_angle);
    if (turn != 0) {
      const float c = std::cos(turn);
      const float s = std::sin(turn);
      out[lid.vertex] +=
          seat.Turned({0, lid.y * c + lid.z * s - lid.y, lid.z * c - lid.y * s - lid.z});
    }
    // The cornea bulges the lid it rolls under.
    constexpr float kThickness = 0.35f;
    constexpr float kOnBall = 12.05f;  // nearer than that lies the fold behind the lids
    const auto side = static_cast<std::size_t>(lid.side);
    const glm::vec3 middle = ball_[side] + seat.size * cornea_ * pose.eye[side][2];
    const glm::vec3 off = out[lid.vertex] - middle;
    const float distance = glm::length(off);
    const bool lid_proper = glm::length(rest_[lid.vertex] - ball_[side]) > seat.size * kOnBall;
    const float least = seat.size * (kCorneaRadius + kThickness);
    if (lid_proper && distance < least && distance > 1) {
      out[lid.vertex] = middle + off * (least / distance);
    }
  }
}

void Deformer::KeepOffTeeth(const Pose& pose, glm::vec3* out) const {
  // How much of a push counts, by height: all beside the crowns, fading past the edge.
  const auto beside = [](const ToothArch& arch, float y) {
    const float down = arch.root_y > arch.edge_y ? 1.0f : -1.0f;
    return SmoothStep(-2.2f, 0.2f, down * (y - arch.edge_y));
  };
  for (const Touching& touch : touching_) {
    glm::vec3& p = out[touch.vertex];
    const float upper = upper_teeth_.At(p.x) + touch.upper_gap - p.z;
    if (upper > 0) p.z += upper * beside(upper_teeth_, p.y);
    glm::vec3 q = IntoJaw(p, pose);
    const float lower = lower_teeth_.At(q.x) + touch.lower_gap - q.z;
    if (lower > 0) {
      q.z += lower * beside(lower_teeth_, q.y);
      p = TurnJaw(q, pose, 1);
    }
  }
}

void Deformer::CloseLips(const Pose& pose, glm::vec3* out) const {
  // Upper and lower lip share the way to each other 0.4 : 0.6. Lips that would cross are pushed
  // back to touch; a seal takes away the rest of the gap in all directions.
  constexpr float kUpperShare = 0.4f;
  std::array<glm::vec3, 64> correction{};
  for (std::size_t k = 0; k < seam_.size(); ++k) {
    const glm::vec3 apart = out[seam_[k].first] - out[seam_[k].second];
    correction[k] = pose.seal * apart;
    correction[k].y += (1 - pose.seal) * std::min(apart.y, 0.0f);
  }
  for (const std::uint32_t i : lipped_) {
    const SkinWeights& f = flesh_[i];
    const glm::vec3 by = correction[static_cast<std::size_t>(f.lip_column)];
    out[i] -= (f.lip_weight > 0 ? kUpperShare : 1 - kUpperShare) * f.lip_weight * by;
  }
}

void Deformer::Deform(const Pose& pose, glm::vec3* out) const {
  std::copy(rest_.begin(), rest_.end(), out);
  for (std::size_t side = 0; side < 2; ++side) {
    for (std::size_t unit = 1; unit < kActionUnits; ++unit) {
      const float weight = pose.units[side][unit];
      if (weight == 0) continue;
      for (const Delta& d : unit_fields_[side][unit]) out[d.vertex] += weight * d.by;
    }
  }
  for (std::size_t p = 0; p < kMouthParameters; ++p) {
    if (pose.mouth[p] == 0) continue;
    for (const Delta& d : mouth_fields_[p]) out[d.vertex] += pose.mouth[p] * d.by;
  }
  MoveLids(pose, out);
  if (pose.jaw_rad != 0 || pose.jaw_slide_mm != 0 || pose.jaw_sway_mm != 0) {
    for (const std::uint32_t i : jawed_) out[i] = TurnJaw(out[i], pose, flesh_[i].jaw);
  }
  KeepOffTeeth(pose, out);
  CloseLips(pose, out);
  KeepOffTeeth(pose, out);  // where closing drew them in again
}

}  // namespace fsm
