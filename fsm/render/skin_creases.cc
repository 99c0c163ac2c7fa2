#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "fsm/render/skin_parts.h"

namespace fsm {

/// A narrow furrow between two low swellings.
float CreaseRelief::Furrow(float off, float width) const {
  if (std::abs(off) > 5.2F * width) return 0;
  return -Bell(off, width) + swelling_ * (Bell(off - 2.2F * width, 1.5F * width) +
                                          Bell(off + 2.2F * width, 1.5F * width));
}

float CreaseRelief::HeightAt(const glm::vec3& p) const {
  if (p.z < 0) return 0;
  const float side = std::abs(p.x);
  float height = 0;
  AddForehead(p, side, height);
  AddGlabella(p, side, height);
  AddBridge(p, side, height);
  AddCrowsFeet(p, side, height);
  AddNasolabial(p, side, height);
  return height;
}

/// Lines that follow the brow, rising a little to the sides of the middle; no line is quite like
/// another.
void CreaseRelief::AddForehead(const glm::vec3& p, float side, float& height) const {
  const float brow_y = m_.nasion.y + 20;
  if (p.y <= brow_y - 2 || p.y >= m_.trichion.y) return;
  const float room = m_.trichion.y - brow_y;
  const float bow = rise_ * std::sin((std::sqrt(side * side + 49) - 7) * 0.055F);
  for (const float& part : forehead_places_) {
    const float reach = (reach_ - less_ * std::abs(part - farthest_)) *
                        (&part == &forehead_places_.back() ? last_ : 1.0F);
    const float sway = sway_long_ * std::sin(p.x * (0.09F + 0.05F * part) + 11 * part) +
                       sway_short_ * std::sin(p.x * 0.27F + 7 * part);
    const float deep = forehead_.depth + deep_long_ * std::sin(p.x * 0.075F + 23 * part) +
                       deep_short_ * std::sin(p.x * 0.19F + 5 * part);
    height += deep * Furrow(p.y - brow_y - room * part * 0.9F - bow - sway, forehead_.width) *
              SmoothStep(reach + 8, reach - 8, side);
  }
}

/// Two upright lines between the brows, and one across the root of the nose, which is the nose's.
void CreaseRelief::AddGlabella(const glm::vec3& p, float side, float& height) const {
  const float between = Bell(p.y - (m_.nasion.y + 10), 9);
  height += glabella_.depth *
            Furrow(side - glabella_side_ - 0.10F * (p.y - m_.nasion.y), glabella_.width) * between;
  height += nasion_.depth * Furrow(p.y - m_.nasion.y + 1.5F - 0.035F * side * side, nasion_.width) *
            Bell(side, nasion_reach_);
}

/// Short lines beside the bridge of the nose that slant down and outward.
void CreaseRelief::AddBridge(const glm::vec3& p, float side, float& height) const {
  if (side >= 16 || p.y >= m_.nasion.y - 2) return;
  for (const float below : bridge_below_) {
    const float off = p.y - (m_.nasion.y - below) + 0.45F * (side - 6) - 0.02F * side * side;
    height += bridge_.depth * Furrow(off, bridge_.width) * SmoothStep(1.5F, 5, side) *
              SmoothStep(14, 9, side);
  }
}

/// Lines that fan out from the outer corner of the eye.
void CreaseRelief::AddCrowsFeet(const glm::vec3& p, float side, float& height) const {
  const glm::vec2 out(side - m_.exocanthion.left.x - 2, p.y - m_.exocanthion.left.y + 0.5F);
  if (out.x <= -2) return;
  for (const float angle : crows_feet_directions_) {
    const glm::vec2 along(std::cos(angle), std::sin(angle));
    const float far = glm::dot(out, along);
    const float off = out.y * along.x - out.x * along.y;
    const float bend = 0.02F * far * far * (angle > 0 ? -1.0F : 1.0F) * 0.5F;
    height += crows_feet_.depth * Furrow(off + bend, crows_feet_.width) * SmoothStep(1, 5, far) *
              SmoothStep(17, 9, far);
  }
}

/// The fold from above the wing of the nose past the corner of the mouth.
void CreaseRelief::AddNasolabial(const glm::vec3& p, float side, float& height) const {
  const glm::vec3 wing = m_.alare.left, corner = m_.cheilion.left;
  const float t = (wing.y + 4 - p.y) / (wing.y + 4 - corner.y);
  const float fold_x =
      glm::mix(wing.x + outside_nose_, corner.x + outside_mouth_, std::clamp(t, 0.0F, 1.3F)) +
      nasolabial_bow_ * std::sin(std::clamp(t, 0.0F, 1.0F) * 3.1416F);
  height += nasolabial_.depth * Furrow((side - fold_x) * 0.8F, nasolabial_.width) *
            SmoothStep(-0.12F, 0.12F, t) * SmoothStep(1.35F, 0.85F, t);
}

bool CreaseRelief::MayCrease(const glm::vec3& p) const {
  const float side = std::abs(p.x);
  const bool fold = p.y < m_.alare.left.y + 12 && p.y > m_.gnathion.y &&
                    side > m_.alare.left.x - 6 && side < m_.cheilion.left.x + 22;
  const bool feet = side > m_.exocanthion.left.x - 4 && std::abs(p.y - m_.exocanthion.left.y) < 16;
  const bool glabella = side < 18 && p.y > m_.nasion.y - 24 && p.y < m_.nasion.y + 32;
  const bool forehead = p.y > m_.nasion.y + 14 && p.y < m_.trichion.y + 2 && side < 58;
  return p.z > 0 && (fold || feet || glabella || forehead);
}

CreaseWeights WeighCreases(const HeadVertices& rest, const FaceLandmarks& m) {
  CreaseWeights out;
  for (const glm::vec3& p : rest.position) {
    const float side = std::abs(p.x);
    const float front = SmoothStep(0, 20, p.z);
    const float brow_y = m.nasion.y + 14;
    const float between = SmoothStep(19, 12, side);
    const float under_forehead = SmoothStep(m.nasion.y + 24, m.nasion.y + 16, p.y);
    const float over_nose = SmoothStep(m.nasion.y, m.nasion.y + 5, p.y);
    const glm::vec4 face =
        front * glm::vec4(SmoothStep(brow_y, brow_y + 8, p.y) * SmoothStep(60, 48, side) *
                              (1 - between * under_forehead),
                          between * over_nose * under_forehead,
                          SmoothStep(m.exocanthion.left.x - 2, m.exocanthion.left.x + 2, side) *
                              Bell(p.y - m.exocanthion.left.y, 14),
                          SmoothStep(m.alare.left.y + 10, m.alare.left.y + 3, p.y) *
                              SmoothStep(m.gnathion.y,
                                         0.6F * m.cheilion.left.y + 0.4F * m.gnathion.y, p.y) *
                              SmoothStep(m.alare.left.x - 4, m.alare.left.x + 1, side));
    const float nose =
        front * between * (1 - over_nose) * SmoothStep(m.nasion.y - 26, m.nasion.y - 18, p.y);
    const bool creases = nose > 0 || face != glm::vec4(0);
    out.face.push_back(face);
    out.nose_and_left.emplace_back(nose, creases ? SmoothStep(-5, 5, p.x) : 0.0F);
  }
  return out;
}

}  // namespace fsm
