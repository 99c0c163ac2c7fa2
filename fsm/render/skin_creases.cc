#include "fsm/render/skin_creases.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "fsm/base/smooth_step.h"

namespace fsm {

/// Returns the profile of a narrow furrow between two low swellings.
float CreaseRelief::Furrow(float off, float width) const {
  if (std::abs(off) > 5.2f * width) return 0;
  return -Bell(off, width) + skin_.crease.swelling * (Bell(off - 2.2f * width, 1.5f * width) +
                                                      Bell(off + 2.2f * width, 1.5f * width));
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

/// Adds lines that follow the brow, rising a little beside the middle. The waves of each have their
/// own phase and length, so that no line equals another.
void CreaseRelief::AddForehead(const glm::vec3& p, float side, float& height) const {
  const auto& lines = skin_.forehead_lines;
  const auto places = ListOf(lines.places);
  const float brow_y = landmarks_.nasion.y + lines.above;
  if (p.y <= brow_y - 2 || p.y >= landmarks_.trichion.y) return;
  const float room = lines.room * (landmarks_.trichion.y - brow_y);
  const float bow = lines.rise * std::sin((std::sqrt(side * side + 49) - 7) * 0.055f);
  for (const float& place : places) {
    const float reach = (lines.reach - lines.less * std::abs(place - lines.farthest)) *
                        (&place == &places.back() ? lines.last : 1.0f);
    const float sway = lines.sway_long * std::sin(p.x * (0.09f + 0.05f * place) + 11 * place) +
                       lines.sway_short * std::sin(p.x * 0.27f + 7 * place);
    const float deep = lines.depth + lines.deep_long * std::sin(p.x * 0.075f + 23 * place) +
                       lines.deep_short * std::sin(p.x * 0.19f + 5 * place);
    height += deep * Furrow(p.y - brow_y - room * place - bow - sway, lines.width) *
              SmoothStep(reach + lines.fades, reach - lines.fades, side);
  }
}

/// Adds two vertical lines between the brows, and the nose's one across the nasion.
void CreaseRelief::AddGlabella(const glm::vec3& p, float side, float& height) const {
  const auto& lines = skin_.glabella_lines;
  const auto& across = skin_.nasion_line;
  const float up = p.y - landmarks_.nasion.y;
  height += lines.depth * Furrow(side - lines.side - lines.lean * up, lines.width) *
            Bell(up - lines.above, lines.height);
  height += across.depth * Furrow(up + across.below - across.arch * side * side, across.width) *
            Bell(side, across.reach);
}

/// Adds short lines beside the bridge of the nose that slant down and outward.
void CreaseRelief::AddBridge(const glm::vec3& p, float side, float& height) const {
  const auto& lines = skin_.bridge_lines;
  if (side >= 16 || p.y >= landmarks_.nasion.y - 2) return;
  for (const float below : ListOf(lines.below)) {
    const float offset =
        p.y - (landmarks_.nasion.y - below) + lines.slant * (side - 6) - lines.bend * side * side;
    height +=
        lines.depth * Furrow(offset, lines.width) * lines.begin.Ramp(side) * lines.end.Ramp(side);
  }
}

/// Adds lines that fan out from the outer corner of the eye.
void CreaseRelief::AddCrowsFeet(const glm::vec3& p, float side, float& height) const {
  const auto& lines = skin_.crows_feet;
  const glm::vec2 out(side - landmarks_.exocanthion.left.x - 2,
                      p.y - landmarks_.exocanthion.left.y + 0.5f);
  if (out.x <= -2) return;
  for (const float angle : ListOf(lines.directions)) {
    const glm::vec2 along(std::cos(angle), std::sin(angle));
    const float along_mm = glm::dot(out, along);
    const float across_mm = out.y * along.x - out.x * along.y;
    const float bend = lines.bend * along_mm * along_mm * (angle > 0 ? -1.0f : 1.0f);
    height += lines.depth * Furrow(across_mm + bend, lines.width) * lines.begin.Ramp(along_mm) *
              lines.end.Ramp(along_mm);
  }
}

/// Adds the fold from above the wing of the nose past the corner of the mouth.
void CreaseRelief::AddNasolabial(const glm::vec3& p, float side, float& height) const {
  const auto& fold = skin_.nasolabial_fold;
  const glm::vec3 wing = landmarks_.alare.left, corner = landmarks_.cheilion.left;
  const float top = wing.y + fold.above;
  const float t = (top - p.y) / (top - corner.y);
  const float fold_x =
      glm::mix(wing.x + fold.nose, corner.x + fold.mouth, std::clamp(t, 0.0f, 1.3f)) +
      fold.bow * std::sin(std::clamp(t, 0.0f, 1.0f) * 3.1416f);
  // A slanting fold is wider if measured along x.
  height += fold.depth * Furrow((side - fold_x) * fold.slants, fold.width) * fold.begin.Ramp(t) *
            fold.end.Ramp(t);
}

bool CreaseRelief::MayCrease(const glm::vec3& p) const {
  const float side = std::abs(p.x);
  const glm::vec3 &nasion = landmarks_.nasion, &alare = landmarks_.alare.left,
                  &eye = landmarks_.exocanthion.left;
  const bool fold = p.y < alare.y + skin_.fold_region.above_wing && p.y > landmarks_.gnathion.y &&
                    side > alare.x - skin_.fold_region.inside_wing &&
                    side < landmarks_.cheilion.left.x + skin_.fold_region.beside_mouth;
  const bool feet = side > eye.x - skin_.crows_feet_region.inside_corner &&
                    std::abs(p.y - eye.y) < skin_.crows_feet_region.up_and_down;
  const bool glabella = side < skin_.glabella_region.side &&
                        p.y > nasion.y - skin_.glabella_region.below_nasion &&
                        p.y < nasion.y + skin_.glabella_region.above_nasion;
  const bool forehead = p.y > nasion.y + skin_.forehead_region.begins &&
                        p.y < landmarks_.trichion.y + skin_.forehead_region.above_hairline &&
                        side < skin_.forehead_region.side;
  return p.z > 0 && (fold || feet || glabella || forehead);
}

CreaseWeights WeighCreases(const HeadVertices& rest, const FaceLandmarks& landmarks,
                           const Appearance& appearance) {
  const auto& skin = appearance.skin;
  const glm::vec3 &nasion = landmarks.nasion, &alare = landmarks.alare.left,
                  &eye = landmarks.exocanthion.left;
  const float chin_y = landmarks.gnathion.y;
  const float full_fold_y = (1 - skin.fold_region.to_chin) * landmarks.cheilion.left.y +
                            skin.fold_region.to_chin * chin_y;
  const float brow_y = nasion.y + skin.forehead_region.begins;
  CreaseWeights out;
  for (const glm::vec3& p : rest.position) {
    const float side = std::abs(p.x);
    const float front = skin.creased.front.Ramp(p.z);
    const float between = skin.glabella_region.fade_side.Ramp(side);
    const float under_forehead = (nasion.y + skin.glabella_region.fade_up).Ramp(p.y);
    const float over_nose = (nasion.y + skin.nose_region.fade_up).Ramp(p.y);
    const glm::vec4 face =
        front *
        glm::vec4((brow_y + skin.forehead_region.fade_up).Ramp(p.y) *
                      skin.forehead_region.fade_side.Ramp(side) * (1 - between * under_forehead),
                  between * over_nose * under_forehead,
                  (eye.x + skin.crows_feet_region.fade_side).Ramp(side) *
                      Bell(p.y - eye.y, skin.crows_feet_region.fade_height),
                  (alare.y + skin.fold_region.fade_up).Ramp(p.y) *
                      SmoothStep(chin_y, full_fold_y, p.y) *
                      (alare.x + skin.fold_region.fade_side).Ramp(side));
    const float nose =
        front * between * (1 - over_nose) * (nasion.y + skin.nose_region.fade_down).Ramp(p.y);
    const float sides = face.x * skin.forehead_region.sides.Ramp(side);
    const bool creases = nose > 0 || face != glm::vec4(0);
    out.face.push_back(face - glm::vec4(sides, 0, 0, 0));
    out.more.emplace_back(nose, sides, creases ? skin.creased.left.Ramp(p.x) : 0.0f);
  }
  return out;
}

}  // namespace fsm
