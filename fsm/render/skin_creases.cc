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
  if (std::abs(off) > 5.2F * width) return 0;
  return -Bell(off, width) + skin_.crease.swelling * (Bell(off - 2.2F * width, 1.5F * width) +
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

/// Adds lines that follow the brow, rising a little beside the middle. The waves of each have their
/// own phase and length, so that no line equals another.
void CreaseRelief::AddForehead(const glm::vec3& p, float side, float& height) const {
  const auto& lines = skin_.forehead_lines;
  const auto places = ListOf(lines.places);
  const float brow_y = landmarks_.nasion.y + lines.above;
  if (p.y <= brow_y - 2 || p.y >= landmarks_.trichion.y) return;
  const float room = lines.room * (landmarks_.trichion.y - brow_y);
  const float bow = lines.rise * std::sin((std::sqrt(side * side + 49) - 7) * 0.055F);
  for (const float& part : places) {
    const float reach = (lines.reach - lines.less * std::abs(part - lines.farthest)) *
                        (&part == &places.back() ? lines.last : 1.0F);
    const float sway = lines.sway_long * std::sin(p.x * (0.09F + 0.05F * part) + 11 * part) +
                       lines.sway_short * std::sin(p.x * 0.27F + 7 * part);
    const float deep = lines.depth + lines.deep_long * std::sin(p.x * 0.075F + 23 * part) +
                       lines.deep_short * std::sin(p.x * 0.19F + 5 * part);
    height += deep * Furrow(p.y - brow_y - room * part - bow - sway, lines.width) *
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
    const float off =
        p.y - (landmarks_.nasion.y - below) + lines.slant * (side - 6) - lines.bend * side * side;
    height += lines.depth * Furrow(off, lines.width) * SmoothStep(lines.begin, side) *
              SmoothStep(lines.end, side);
  }
}

/// Adds lines that fan out from the outer corner of the eye.
void CreaseRelief::AddCrowsFeet(const glm::vec3& p, float side, float& height) const {
  const auto& lines = skin_.crows_feet;
  const glm::vec2 out(side - landmarks_.exocanthion.left.x - 2,
                      p.y - landmarks_.exocanthion.left.y + 0.5F);
  if (out.x <= -2) return;
  for (const float angle : ListOf(lines.directions)) {
    const glm::vec2 along(std::cos(angle), std::sin(angle));
    const float far = glm::dot(out, along);
    const float off = out.y * along.x - out.x * along.y;
    const float bend = lines.bend * far * far * (angle > 0 ? -1.0F : 1.0F);
    height += lines.depth * Furrow(off + bend, lines.width) * SmoothStep(lines.begin, far) *
              SmoothStep(lines.end, far);
  }
}

/// Adds the fold from above the wing of the nose past the corner of the mouth.
void CreaseRelief::AddNasolabial(const glm::vec3& p, float side, float& height) const {
  const auto& fold = skin_.nasolabial_fold;
  const glm::vec3 wing = landmarks_.alare.left, corner = landmarks_.cheilion.left;
  const float top = wing.y + fold.above;
  const float t = (top - p.y) / (top - corner.y);
  const float fold_x =
      glm::mix(wing.x + fold.nose, corner.x + fold.mouth, std::clamp(t, 0.0F, 1.3F)) +
      fold.bow * std::sin(std::clamp(t, 0.0F, 1.0F) * 3.1416F);
  // A slanting fold is wider if measured along x.
  height += fold.depth * Furrow((side - fold_x) * fold.slants, fold.width) *
            SmoothStep(fold.begin, t) * SmoothStep(fold.end, t);
}

bool CreaseRelief::MayCrease(const glm::vec3& p) const {
  const float side = std::abs(p.x);
  const bool fold = p.y < landmarks_.alare.left.y + 12 && p.y > landmarks_.gnathion.y &&
                    side > landmarks_.alare.left.x - 6 && side < landmarks_.cheilion.left.x + 22;
  const bool feet = side > landmarks_.exocanthion.left.x - 4 &&
                    std::abs(p.y - landmarks_.exocanthion.left.y) < 16;
  const bool glabella =
      side < 18 && p.y > landmarks_.nasion.y - 24 && p.y < landmarks_.nasion.y + 32;
  const bool forehead =
      p.y > landmarks_.nasion.y + 14 && p.y < landmarks_.trichion.y + 2 && side < 58;
  return p.z > 0 && (fold || feet || glabella || forehead);
}

CreaseWeights WeighCreases(const HeadVertices& rest, const FaceLandmarks& landmarks) {
  CreaseWeights out;
  for (const glm::vec3& p : rest.position) {
    const float side = std::abs(p.x);
    const float front = SmoothStep(0, 20, p.z);
    const float brow_y = landmarks.nasion.y + 14;
    const float between = SmoothStep(19, 12, side);
    const float under_forehead = SmoothStep(landmarks.nasion.y + 24, landmarks.nasion.y + 16, p.y);
    const float over_nose = SmoothStep(landmarks.nasion.y, landmarks.nasion.y + 5, p.y);
    const glm::vec4 face =
        front *
        glm::vec4(
            SmoothStep(brow_y, brow_y + 8, p.y) * SmoothStep(60, 48, side) *
                (1 - between * under_forehead),
            between * over_nose * under_forehead,
            SmoothStep(landmarks.exocanthion.left.x - 2, landmarks.exocanthion.left.x + 2, side) *
                Bell(p.y - landmarks.exocanthion.left.y, 14),
            SmoothStep(landmarks.alare.left.y + 10, landmarks.alare.left.y + 3, p.y) *
                SmoothStep(landmarks.gnathion.y,
                           0.6F * landmarks.cheilion.left.y + 0.4F * landmarks.gnathion.y, p.y) *
                SmoothStep(landmarks.alare.left.x - 4, landmarks.alare.left.x + 1, side));
    const float nose = front * between * (1 - over_nose) *
                       SmoothStep(landmarks.nasion.y - 26, landmarks.nasion.y - 18, p.y);
    const bool creases = nose > 0 || face != glm::vec4(0);
    out.face.push_back(face);
    out.nose_and_left.emplace_back(nose, creases ? SmoothStep(-5, 5, p.x) : 0.0F);
  }
  return out;
}

}  // namespace fsm
