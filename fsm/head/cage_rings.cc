#include "fsm/head/cage_rings.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <stdexcept>

#include "fsm/base/pi.h"
#include "fsm/base/smooth_step.h"

namespace fsm {
namespace {

void Add(Cage& cage, const std::string& curve, glm::vec3 p, const CageTag& tag) {
  cage.curves[curve].push_back(static_cast<std::uint32_t>(cage.position.size()));
  cage.position.push_back(p);
  cage.tag.push_back(tag);
}

/// The position of point i of a lid curve: x, and the lid it is on; corners count as upper lid.
struct MarginPoint {
  float x;
  bool upper;
  bool corner;
};

MarginPoint PointOnLid(const EyeAnatomy& eye, int i) {
  constexpr int kHalf = kLidPoints / 2;
  const bool upper = i <= kHalf;
  const int along = upper ? i : kLidPoints - i;  // 0 inner corner .. kHalf outer corner
  const float t = static_cast<float>(along) / kHalf;
  // Points are denser towards the corners, where the lids bend most.
  const float share = 0.5f - 0.5f * std::cos(kPi * (0.12f + 0.76f * t));
  const float from = 0.5f - 0.5f * std::cos(kPi * 0.12f);
  const float x = glm::mix(eye.inner_x(), eye.outer_x(), (share - from) / (1 - 2 * from));
  return {x, upper, along == 0 || along == kHalf};
}

/// `edge`: the corresponding point on the edge of the socket.
glm::vec3 PointOfRing(const EyeAnatomy& eye, const MarginPoint& at, const LidRing& ring,
                      glm::vec3 edge) {
  const float margin = at.upper ? eye.UpperAngle(at.x) : eye.LowerAngle(at.x);
  const float mm = at.upper ? ring.upper_mm : -ring.lower_mm;
  const float radius = eye.LidRadius(at.x);
  const float reach = std::min(1.0f, radius / 9);
  glm::vec3 p = eye.LidPoint(at.x, margin + mm * reach / std::max(radius, 5.0f), radius);
  if (at.corner || radius < 7) {
    // Beside the ball the rings are interpolated to the edge of the socket.
    const glm::vec3 walked =
        glm::mix(eye.LidPoint(at.x, margin, radius), edge, std::abs(mm) / 13.0f);
    p = glm::mix(p, walked, at.corner ? 1.0f : SmoothStep(7, 3, radius));
  }
  p = glm::mix(p, edge, ring.to_orbit);
  const float along = (at.x - eye.inner_x()) / (eye.outer_x() - eye.inner_x());
  if (!at.upper && !at.corner) {
    const glm::vec3 straight = glm::mix(eye.LidPoint(at.x, margin, radius), edge,
                                        std::min(1.0f, ring.lower_mm / eye.below_width()));
    p.z += eye.below_fill() * std::max(0.0f, straight.z - p.z);
    p = glm::mix(p, straight, eye.below_fill() * SmoothStep(0.55f, 0.85f, along));
  }
  const float upper_lift = ring.upper_lift + ring.fill * eye.upper_fill();
  p.z += (at.upper ? upper_lift : ring.lower_lift) * SmoothStep(0.02f, 0.4f, along) *
         SmoothStep(1.0f, at.upper ? 0.8f : 0.85f, along);
  return p;
}

/// The position of point k of a mouth curve: from the middle of the upper lip around the corner to
/// the middle of the lower lip; the corner counts as upper lip.
struct LipPoint {
  int column;
  float x;  ///< millimetres from the middle
  bool upper;
  float upper_lip;  ///< as CageTag::upper_lip
};

LipPoint PointOnLips(const MouthAnatomy& mouth, int k) {
  const bool upper = k <= kLipColumns;
  const int column = upper ? k : 2 * kLipColumns - k;
  const float upper_lip = column == kLipColumns ? 0.0f : upper ? 1.0f : -1.0f;
  return {column, mouth.column_x()[static_cast<std::size_t>(column)], upper, upper_lip};
}

/// Returns a point on the red of the lips; `red`: 0 at the seam, 1 at the vermilion border.
glm::vec3 PointOfRed(const MouthAnatomy& mouth, const LipPoint& at, float red) {
  glm::vec3 p = mouth.VermilionPoint(at.upper ? Lip::kUpper : Lip::kLower, at.x, red);
  // The rings pass around the corner side by side.
  p += glm::vec3(1.0f, 0, -0.7f) * (red * 2.0f * SmoothStep(17, mouth.corner().x, at.x));
  p.y += at.upper_lip * 0.5f * red * SmoothStep(14, 22, at.x);
  return p;
}

glm::vec3 PointOfBag(const MouthAnatomy& mouth, const LipPoint& at, const BagRing& bag) {
  const BagBend& bend = mouth.bag_bend();
  const float corner_x = mouth.corner().x;
  const float open = std::sqrt(std::max(0.0f, 1 - at.x * at.x / (corner_x * corner_x)));
  const float web = bag.web * SmoothStep(bend.web_x[0], bend.web_x[1], at.x);
  glm::vec3 p = mouth.VermilionPoint(Lip::kUpper, at.x, 0);
  p.x *= glm::mix(std::min(bag.widen, 1.0f), bag.widen, std::min(1.0f, bend.width * open));
  p.x *= 1 - web;
  p.y += at.upper_lip * bag.height * (bend.height[0] + bend.height[1] * open);
  p.z -= bag.back * (bend.depth[0] + bend.depth[1] * open) * (1 - bend.web_depth * web);
  return p;
}

}  // namespace

void AddLidCurves(const EyeAnatomy& eye, Cage& cage) {
  const auto orbit = cage.curves.find("orbit");
  if (orbit == cage.curves.end() || orbit->second.size() != kLidPoints) {
    throw std::runtime_error("tables/curves.txt: curve 'orbit' must have 18 points");
  }
  for (int i = 0; i < kLidPoints; ++i) {
    const MarginPoint at = PointOnLid(eye, i);
    const float margin = at.upper ? eye.UpperAngle(at.x) : eye.LowerAngle(at.x);
    CageTag tag;
    tag.eye = 1;
    tag.margin = 0;
    tag.lid_upper = at.corner ? 0.5f : at.upper ? 1.0f : 0.0f;
    tag.lid_lower = 1 - tag.lid_upper;
    // First the wet edge behind the margin, then a point back on the ball.
    const float inside = eye.InnerRadius(at.x);
    const glm::vec3 behind =
        eye.LidPoint(at.x, margin + (at.upper ? 0.35f : -0.35f), inside - 0.2f);
    glm::vec3 from_ball = behind - eye.centre();
    from_ball.x = std::clamp(from_ball.x, -10.2f, 10.2f);
    Add(cage, "eye0", eye.centre() + (eye.radius() - 0.15f) * glm::normalize(from_ball), tag);
    Add(cage, "eye1", eye.LidPoint(at.x, margin, inside), tag);
    const glm::vec3 edge = cage.position[orbit->second[static_cast<std::size_t>(i)]];
    for (std::size_t r = 0; r < eye.lid_rings().size(); ++r) {
      const LidRing& ring = eye.lid_rings()[r];
      CageTag lid = tag;
      lid.margin = at.upper ? ring.upper_mm : ring.lower_mm;
      lid.eye = at.upper ? ring.upper_hold : ring.lower_hold;
      // Outward of the ball the lids' axis is close, so points far from it must not move.
      if (r >= 2 && !at.corner && at.x > eye.centre().x) {
        lid.eye *= std::min(1.0f, eye.LidRadius(at.x) / 9);
      }
      lid.lid_upper *= lid.eye;
      lid.lid_lower *= lid.eye;
      Add(cage, "eye" + std::to_string(r + 2), PointOfRing(eye, at, ring, edge), lid);
    }
  }
}

void AddMouthCurves(const MouthAnatomy& mouth, Cage& cage) {
  constexpr std::array<float, kMouthRings - kSeamRing> kRed = {0, 0.3f, 0.66f, 1};
  if (mouth.bag_rings().size() != kSeamRing || mouth.column_x().size() != kLipColumns + 1) {
    throw std::runtime_error(
        "tables/mouth.txt: 6 rows 'bag_ring' and 7 numbers of 'column_x' expected");
  }
  for (int ring = 0; ring < kMouthRings; ++ring) {
    const std::string name = "mouth" + std::to_string(ring);
    for (int k = 0; k <= 2 * kLipColumns; ++k) {
      const LipPoint at = PointOnLips(mouth, k);
      if (ring == 0 && !at.upper) {  // both halves meet at the bag's end
        cage.curves[name].push_back(cage.curves[name][static_cast<std::size_t>(at.column)]);
        continue;
      }
      CageTag tag;
      tag.upper_lip = at.upper_lip;
      tag.lip_column = static_cast<float>(at.column);
      if (ring >= kSeamRing) {
        tag.red = kRed[static_cast<std::size_t>(ring - kSeamRing)];
        tag.lip_hold = 1;
        tag.seam = ring == kSeamRing ? 1.0f : 0.0f;
        Add(cage, name, PointOfRed(mouth, at, tag.red), tag);
      } else {
        const BagRing& bag = mouth.bag_rings()[static_cast<std::size_t>(ring)];
        tag.red = 0;
        tag.deep = static_cast<float>(kSeamRing - ring) / kSeamRing;
        tag.lip_hold = bag.lip_hold;
        Add(cage, name, PointOfBag(mouth, at, bag), tag);
      }
    }
  }
}

}  // namespace fsm
