#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "fsm/render/skin_parts.h"

namespace fsm {
namespace {

float Furrow(float off, float width) {
  if (std::abs(off) > 5.2F * width) return 0;
  // A narrow furrow between two low swellings.
  return -Bell(off, width) +
         0.35F * (Bell(off - 2.2F * width, 1.5F * width) + Bell(off + 2.2F * width, 1.5F * width));
}

}  // namespace

float CreaseHeight(const glm::vec3& p, const FaceMarks& m) {
  if (p.z < 0) return 0;
  const float side = std::abs(p.x);
  float height = 0;
  // Forehead: lines that follow the brow, rising a little to the sides of the middle.
  const float brow_y = m.nasion.y + 20;
  if (p.y > brow_y - 2 && p.y < m.trichion.y) {
    const float room = m.trichion.y - brow_y;
    // Round in the middle, and no line quite like another.
    const float bow = 2.5F * std::sin((std::sqrt(side * side + 49) - 7) * 0.055F);
    for (const float part : {0.20F, 0.40F, 0.60F, 0.78F}) {
      const float reach = (46 - 26 * std::abs(part - 0.45F)) * (part == 0.78F ? 0.7F : 1.0F);
      const float sway = 0.9F * std::sin(p.x * (0.09F + 0.05F * part) + 11 * part) +
                         0.4F * std::sin(p.x * 0.27F + 7 * part);
      const float deep = 0.6F + 0.25F * std::sin(p.x * 0.075F + 23 * part) +
                         0.15F * std::sin(p.x * 0.19F + 5 * part);
      height += deep * Furrow(p.y - brow_y - room * part * 0.9F - bow - sway, 1.15F) *
                Smooth(reach + 8, reach - 8, side);
    }
  }
  // Glabella: two upright lines between the brows, one across the root of the nose.
  const float between = Bell(p.y - (m.nasion.y + 10), 9);
  height += 0.9F * Furrow(side - 6.5F - 0.10F * (p.y - m.nasion.y), 1.1F) * between;
  height += 0.3F * Furrow(p.y - m.nasion.y + 1.5F - 0.035F * side * side, 1.7F) * Bell(side, 5);
  // Beside the bridge of the nose: three short lines that slant down and outward.
  if (side < 16 && p.y < m.nasion.y - 2) {
    for (const float below : {7.0F, 11.5F, 16.0F}) {
      const float off = p.y - (m.nasion.y - below) + 0.45F * (side - 6) - 0.02F * side * side;
      height += 0.4F * Furrow(off, 1.0F) * Smooth(1.5F, 5, side) * Smooth(14, 9, side);
    }
  }
  // Crow's feet: three lines fanning out from the outer corner of the eye.
  const glm::vec2 out(side - m.exocanthion.left.x - 2, p.y - m.exocanthion.left.y + 0.5F);
  if (out.x > -2) {
    for (const float angle : {0.50F, 0.05F, -0.42F}) {
      const glm::vec2 along(std::cos(angle), std::sin(angle));
      const float far = glm::dot(out, along);
      const float off = out.y * along.x - out.x * along.y;
      height += 0.55F * Furrow(off + 0.02F * far * far * (angle > 0 ? -1.0F : 1.0F) * 0.5F, 0.8F) *
                Smooth(1, 5, far) * Smooth(17, 9, far);
    }
  }
  // Nasolabial fold: from above the wing of the nose past the corner of the mouth.
  const glm::vec3 wing = m.alare.left;
  const glm::vec3 corner = m.cheilion.left;
  const float t = (wing.y + 4 - p.y) / (wing.y + 4 - corner.y);
  const float fold_x = glm::mix(wing.x + 2, corner.x + 9, std::clamp(t, 0.0F, 1.3F)) +
                       3.5F * std::sin(std::clamp(t, 0.0F, 1.0F) * 3.1416F);
  height += 1.1F * Furrow((side - fold_x) * 0.8F, 1.7F) * Smooth(-0.12F, 0.12F, t) *
            Smooth(1.35F, 0.85F, t);
  return height;
}

bool MayCrease(const glm::vec3& p, const FaceMarks& m) {
  const float side = std::abs(p.x);
  const bool fold = p.y < m.alare.left.y + 12 && p.y > m.gnathion.y && side > m.alare.left.x - 6 &&
                    side < m.cheilion.left.x + 22;
  const bool feet = side > m.exocanthion.left.x - 4 && std::abs(p.y - m.exocanthion.left.y) < 16;
  const bool glabella = side < 18 && p.y > m.nasion.y - 24 && p.y < m.nasion.y + 32;
  const bool forehead = p.y > m.nasion.y + 14 && p.y < m.trichion.y + 2 && side < 58;
  return p.z > 0 && (fold || feet || glabella || forehead);
}

CreaseWeights WeighCreases(const HeadVertices& rest, const FaceMarks& m) {
  CreaseWeights out;
  for (const glm::vec3& p : rest.position) {
    const float side = std::abs(p.x);
    const float front = Smooth(0, 20, p.z);
    const float left = Smooth(-5, 5, p.x);
    const float brow_y = m.nasion.y + 14;
    const float between = Smooth(19, 12, side);
    const glm::vec4 weights =
        front *
        glm::vec4(Smooth(brow_y, brow_y + 8, p.y) * Smooth(60, 48, side) *
                      (1 - between * Smooth(m.nasion.y + 24, m.nasion.y + 16, p.y)),
                  between * Smooth(m.nasion.y - 26, m.nasion.y - 18, p.y) *
                      Smooth(m.nasion.y + 24, m.nasion.y + 16, p.y),
                  Smooth(m.exocanthion.left.x - 2, m.exocanthion.left.x + 2, side) *
                      Bell(p.y - m.exocanthion.left.y, 14),
                  Smooth(m.alare.left.y + 10, m.alare.left.y + 3, p.y) *
                      Smooth(m.gnathion.y, 0.6F * m.cheilion.left.y + 0.4F * m.gnathion.y, p.y) *
                      Smooth(m.alare.left.x - 4, m.alare.left.x + 1, side));
    out.left.push_back(weights * left);
    out.right.push_back(weights * (1 - left));
  }
  return out;
}

}  // namespace fsm
