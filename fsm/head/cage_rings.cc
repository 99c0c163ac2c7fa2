#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <stdexcept>

#include "fsm/base/spline.h"
#include "fsm/head/cage.h"

namespace fsm {
namespace {

void Add(Cage& cage, const std::string& curve, glm::vec3 p, const CageTag& tag) {
  cage.curves[curve].push_back(static_cast<std::uint32_t>(cage.position.size()));
  cage.position.push_back(p);
  cage.tag.push_back(tag);
}

/// Where lid point i lies: x, and whether on the upper lid; corners count as both.
struct LidPlace {
  float x;
  bool upper;
  bool corner;
};

LidPlace PlaceOnLid(const EyeAnatomy& eye, int i) {
  constexpr int kHalf = kLidPoints / 2;
  const bool upper = i <= kHalf;
  const int along = upper ? i : kLidPoints - i;  // 0 inner corner .. kHalf outer corner
  const float t = static_cast<float>(along) / kHalf;
  // Closer together towards the corners, where lids bend most.
  const float part = 0.5f - 0.5f * std::cos(3.14159265f * (0.12f + 0.76f * t));
  const float from = 0.5f - 0.5f * std::cos(3.14159265f * 0.12f);
  const float x = glm::mix(eye.inner_x(), eye.outer_x(), (part - from) / (1 - 2 * from));
  return {x, upper, along == 0 || along == kHalf};
}

}  // namespace

void AddLidCurves(const EyeAnatomy& eye, Cage& cage) {
  // Distance from the margin on the lid's surface, part of the turn, and how far the ring has gone
  // over from the lids' own surface towards the socket's edge.
  struct Ring {
    float upper_mm, lower_mm, hold_upper, hold_lower, to_orbit, lift;
  };
  constexpr std::array kRings = {Ring{0.1f, 0.1f, 1, 1, 0, 0}, Ring{3.4f, 3.2f, 0.94f, 0.85f, 0, 0},
                                 Ring{6.3f, 6.6f, 0.6f, 0.5f, 0.04f, -0.5f},
                                 Ring{8.2f, 10.0f, 0.28f, 0.22f, 0.50f, 0.9f}};
  const auto orbit = cage.curves.find("orbit");
  if (orbit == cage.curves.end() || orbit->second.size() != kLidPoints) {
    throw std::runtime_error("tables/curves.txt: curve 'orbit' must have 18 points");
  }
  for (int i = 0; i < kLidPoints; ++i) {
    const LidPlace at = PlaceOnLid(eye, i);
    const float margin = at.upper ? eye.UpperAngle(at.x) : eye.LowerAngle(at.x);
    const float side = at.upper ? 1.0f : -1.0f;
    CageTag tag;
    tag.eye = 1;
    tag.margin = 0;
    tag.lid_upper = at.corner ? 0.5f : at.upper ? 1.0f : 0.0f;
    tag.lid_lower = 1 - tag.lid_upper;
    // The wet edge behind the rim, then back onto the ball.
    glm::vec3 behind = eye.OnLid(at.x, margin + 0.35f * side, eye.InnerRadius(at.x) - 0.2f);
    glm::vec3 from_ball = behind - eye.centre();
    from_ball.x = std::clamp(from_ball.x, -10.2f, 10.2f);
    behind = eye.centre() + (eye.radius() - 0.15f) * glm::normalize(from_ball);
    Add(cage, "eye0", behind, tag);
    // Corners turn by both lids' means, which is nothing at all.
    const glm::vec3 edge = cage.position[orbit->second[static_cast<std::size_t>(i)]];
    const glm::vec3 wet = eye.OnLid(at.x, margin, eye.InnerRadius(at.x));
    tag.margin = 0;
    Add(cage, "eye1", wet, tag);
    for (std::size_t r = 0; r < kRings.size(); ++r) {
      const Ring& ring = kRings[r];
      const float mm = at.upper ? ring.upper_mm : ring.lower_mm;
      const float radius = eye.LidRadius(at.x);
      const float reach = std::min(1.0f, radius / 9);
      glm::vec3 p = eye.OnLid(at.x, margin + side * mm * reach / std::max(radius, 5.0f), radius);
      glm::vec3 direct = eye.OnLid(at.x, margin, radius);
      if (at.corner || radius < 7) {
        // Beside the ball the rings simply walk out to the socket's edge.
        const float walk = mm / 13.0f;
        const float corner = at.corner ? 1.0f : SmoothStep(7, 3, radius);
        p = glm::mix(p, glm::mix(direct, edge, walk), corner);
      }
      p = glm::mix(p, edge, ring.to_orbit);
      const float along = (at.x - eye.inner_x()) / (eye.outer_x() - eye.inner_x());
      p.z += ring.lift * SmoothStep(0.02f, 0.4f, along) * SmoothStep(1.0f, 0.8f, along) *
             (at.upper ? 1.0f : 0.45f);
      CageTag lid = tag;
      lid.margin = mm;
      const float hold = at.upper ? ring.hold_upper : ring.hold_lower;
      lid.eye = hold;
      lid.lid_upper *= hold;
      lid.lid_lower *= hold;
      Add(cage, "eye" + std::to_string(r + 2), p, lid);
    }
  }
}

void AddMouthCurves(const MouthAnatomy& mouth, Cage& cage) {
  constexpr std::array<float, kLipColumns + 1> kX = {0, 3.8f, 8.0f, 12.8f, 17.6f, 22.0f, 25.0f};
  struct Bag {
    float height, back, widen;
    // Flesh closes the corners of an open mouth: how much nearer to the middle than the lips.
    float web;
  };
  // From the deepest ring to the inside of the lips.
  constexpr std::array<Bag, kSeamRing> kBag = {
      Bag{0, 62, 0.5f, 0},         Bag{12, 48, 1.08f, 0},       Bag{15, 26, 1.2f, 0},
      Bag{11.5f, 11, 1.1f, 0.12f}, Bag{4.6f, 5.2f, 1.0f, 0.2f}, Bag{1.2f, 2.4f, 1.0f, 0.13f}};
  constexpr std::array<float, kMouthRings - kSeamRing> kRed = {0, 0.3f, 0.66f, 1};
  for (int ring = 0; ring < kMouthRings; ++ring) {
    const std::string name = "mouth" + std::to_string(ring);
    for (int k = 0; k <= 2 * kLipColumns; ++k) {
      const bool upper = k <= kLipColumns;
      const int column = upper ? k : 2 * kLipColumns - k;
      const float x = kX[static_cast<std::size_t>(column)];
      const bool corner = column == kLipColumns;
      const float side = corner ? 0.0f : upper ? 1.0f : -1.0f;
      if (ring == 0 && !upper) {  // the bag's end: both halves meet
        cage.curves[name].push_back(cage.curves[name][static_cast<std::size_t>(column)]);
        continue;
      }
      CageTag tag;
      tag.lip_side = side;
      tag.lip_column = static_cast<float>(column);
      const float open = std::sqrt(std::max(0.0f, 1 - x * x / (25.0f * 25.0f)));
      glm::vec3 p;
      if (ring >= kSeamRing) {
        tag.red = kRed[static_cast<std::size_t>(ring - kSeamRing)];
        tag.lip_hold = 1;
        tag.seam = ring == kSeamRing ? 1.0f : 0.0f;
        p = mouth.Red(upper ? 1 : -1, x, tag.red);
        // Rings go round the corner, side by side.
        p += glm::vec3(1.0f, 0, -0.7f) * (tag.red * 2.0f * SmoothStep(17, 25, x));
        p.y += (upper ? 0.5f : -0.5f) * tag.red * SmoothStep(14, 22, x) * (corner ? 0.0f : 1.0f);
      } else {
        const Bag& bag = kBag[static_cast<std::size_t>(ring)];
        tag.red = 0;
        tag.deep = static_cast<float>(kSeamRing - ring) / kSeamRing;
        tag.lip_hold = ring >= 4 ? 1.0f : ring == 3 ? 0.6f : 0.0f;
        p = mouth.Red(1, x, 0);
        p.x *= glm::mix(std::min(bag.widen, 1.0f), bag.widen, std::min(1.0f, 2 * open));
        const float web = bag.web * SmoothStep(14, 24, x);
        p.x *= 1 - web;
        p.y += side * bag.height * (0.15f + 0.85f * open);
        p.z -= bag.back * (0.85f + 0.15f * open) * (1 - 3 * web);
      }
      Add(cage, name, p, tag);
    }
  }
}

}  // namespace fsm
