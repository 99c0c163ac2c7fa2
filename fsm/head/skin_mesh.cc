#include "fsm/head/skin_mesh.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "fsm/base/number_table.h"
#include "fsm/base/smooth_step.h"
#include "fsm/head/hair_parts.h"
#include "fsm/head/landmarks.h"
#include "fsm/head/paint.h"

namespace fsm {
namespace {

// How the skin hangs on skull, jaw, lids and lips: distances in millimetres, others are weights or
// parts of a CageTag's values.
constexpr struct {
  float rounds_from_z = 45, rounds = 0.9f;        // behind it the skin is longer than it looks,
  glm::vec2 free_z{-5, 25};                       // and behind this it does not follow the units
  glm::vec2 neck_y{-166, -98};                    // from the shoulders to the head, along a line
  float nape_z = -25, nape_slope = 0.35f;         // that rises behind this by so much per mm
  float lid_hold = 1.1f;                          // how much of their freedom lids lose
  float touches_teeth = 0.6f, past_teeth = 0.4f;  // least lip_hold, most depth in the bag
  float bag_hold = 2.2f, bag_hold_less = 1.4f;    // of the freedom, less at the corners
  glm::vec2 bag_jaw{0.2f, 0.7f};                  // depth over which the bag's half moves as
  float lower_bag_jaw = 0.9f;                     // this part of the jaw (the upper: 0)
  float bag_end = 0.95f, bag_end_jaw = 0.4f;      // and its end, from this depth on
} kHold{};

float Sign(float v) { return v > 0 ? 1.0f : v < 0 ? -1.0f : 0.0f; }

/// Returns twice the cage's column; signed, 0 at the median.
int FineColumn(const CageTag& tag, float x) {
  return static_cast<int>(std::lround(2 * tag.lip_column * Sign(x)));
}

constexpr int kLastColumn = 2 * kLipColumns - 1;

BakeWeights MakeSkinWeights(const CageTag& tag, glm::vec3 p, const MouthAnatomy& mouth) {
  const float a = std::abs(p.x);
  const float corner_x = mouth.corner().x;
  const bool lips = tag.lip_hold > 0 || tag.deep > 0;
  const int side = lips ? static_cast<int>(Sign(tag.lip_side)) : 0;
  // At the side of the head distances along the skin exceed those in the frontal view.
  const float round = a + kHold.rounds * std::max(0.0f, kHold.rounds_from_z - p.z);
  glm::vec2 domain(p.x < 0 ? -round : round, p.y);
  if (tag.deep > 0) domain.y = mouth.LineY(std::min(a, corner_x));
  BakeWeights weights{.skin = SkinWeightsAt(domain, side, mouth.LineY(std::min(a, corner_x)))};
  weights.skin.free = SmoothStep(kHold.free_z, p.z);
  weights.skin.neck =
      SmoothStep(kHold.neck_y, p.y - kHold.nape_slope * std::max(0.0f, kHold.nape_z - p.z));
  if (tag.eye > 0) {
    weights.eye = p.x < 0 ? Side::kRight : Side::kLeft;
    weights.lid_upper = tag.lid_upper;
    weights.lid_lower = tag.lid_lower;
    weights.skin.free = std::max(0.0f, 1 - kHold.lid_hold * tag.eye);
  }
  const int column = FineColumn(tag, p.x);
  if (tag.lip_hold > 0 && std::abs(column) <= kLastColumn && tag.lip_side != 0) {
    weights.lip_column = static_cast<std::int16_t>(column + kLastColumn);
    weights.lip_weight = tag.lip_hold * Sign(tag.lip_side);
  }
  weights.by_teeth =
      (tag.red >= 0 || tag.lip_hold >= kHold.touches_teeth) && tag.deep < kHold.past_teeth;
  if (tag.deep > 0) {
    const float open = std::sqrt(std::max(0.0f, 1 - a * a / (corner_x * corner_x)));
    weights.skin.free *=
        std::max(0.0f, 1 - (kHold.bag_hold - kHold.bag_hold_less * (1 - open)) * tag.deep);
    const float rigid = tag.lip_side >= 0 ? 0.0f : kHold.lower_bag_jaw;
    weights.skin.jaw = glm::mix(weights.skin.jaw, rigid,
                                SmoothStep(kHold.bag_jaw, tag.deep) * std::abs(Sign(tag.lip_side)));
    if (tag.deep > kHold.bag_end) weights.skin.jaw = kHold.bag_end_jaw;
  }
  return weights;
}

PaintedSkin MakePaint(const CageTag& tag, glm::vec3 p, SkinKind kind, const SkinPainter& painter,
                      const Identity& identity) {
  const Features& features = identity.UsedFeatures();
  const Palette& palette = identity.palette;
  PaintedSkin paint = painter.At(p);
  if (tag.deep > 0) {
    paint.albedo = glm::mix(palette.lip_inside, palette.mouth,
                            SmoothStep(features.skin_paint.dark_inside, tag.deep));
    const float out = 1 - tag.deep;
    const glm::vec2 light = features.mouth_light;
    paint.openness = light.x + light.y * out * out;
    return paint;
  }
  if (tag.red >= 0 && kind == SkinKind::kLip) {
    const float aside = std::abs(p.x);
    const float reddened =
        features.lip_red.middle * SmoothStep(features.skin_paint.red_edge, tag.red) *
        (1 - features.lip_red.less_aside * SmoothStep(features.lip_red.aside, aside));
    paint.albedo = glm::mix(paint.albedo, palette.lip, reddened);
    // The edge of the red is soft; the middle of the lips is wet.
    const float wet = SmoothStep(features.skin_paint.wet, tag.red) *
                      (1 - features.lip_wet.less_aside * SmoothStep(features.lip_wet.aside, aside));
    paint.albedo = glm::mix(paint.albedo, palette.lip_inside, features.lip_wet.middle * wet);
    paint.openness *= 1 - features.lip_wet.shade * wet;
    // The corners lie deep.
    paint.openness *= 1 - features.lip_corner.shade * SmoothStep(features.lip_corner.aside, aside);
    // The lower lip rolls into the mouth, so its edge is in its own shade.
    if (tag.lip_side < 0)
      paint.openness *=
          1 - features.lip_wet.lower_edge * SmoothStep(features.skin_paint.lower_edge, tag.red);
  }
  if (tag.hole > 0) {
    paint.albedo =
        glm::mix(paint.albedo, features.nostril_colour, features.nostril_dark.colour * tag.hole);
    paint.openness *= 1 - features.nostril_dark.shade * tag.hole;
  }
  if (tag.margin >= 0 && tag.margin < features.skin_paint.lid_rim_mm) {
    paint.albedo = glm::mix(paint.albedo, palette.lid_rim, features.lid_rim.colour);
    paint.openness *= features.lid_rim.light;
  }
  return paint;
}

}  // namespace

MouthSlit BuildSkin(const FineSkin& skin, const EyeAnatomy& eye, const MouthAnatomy& mouth,
                    const Identity& identity, HeadMesh& mesh) {
  const SkinPainter painter(identity, eye);
  const HairLook hair(identity);
  std::vector<SkinKind> kind(skin.position.size(), SkinKind::kSkin);
  for (const FineSkin::Triangle& t : skin.triangles) {
    for (const std::uint32_t v : t.corner) kind[v] = std::max(kind[v], t.kind);
  }
  MouthSlit slit;
  slit.seam.resize(2 * kLastColumn + 1);
  for (std::uint32_t v = 0; v < skin.position.size(); ++v) {
    const glm::vec3 p = skin.position[v];
    const CageTag& tag = skin.tag[v];
    const PaintedSkin paint = MakePaint(tag, p, kind[v], painter, identity);
    mesh.Add(p, paint.albedo, paint.openness, Bone::kSkin, MakeSkinWeights(tag, p, mouth));
    if (tag.seam < 1) continue;
    const int column = FineColumn(tag, p.x);
    if (std::abs(column) > kLastColumn) {
      (p.x > 0 ? slit.corner_left : slit.corner_right) = v;
    } else {
      auto& pair = slit.seam[static_cast<std::size_t>(column + kLastColumn)];
      (tag.lip_side > 0 ? pair.first : pair.second) = v;
    }
  }
  for (const FineSkin::Triangle& t : skin.triangles) {
    const auto covered = [&](std::uint32_t v) {
      return hair.AboveHairline(skin.position[v]) >
             identity.UsedFeatures().skin_paint.hidden_beyond;
    };
    if (std::ranges::all_of(t.corner, covered)) continue;
    const Material material = t.kind == SkinKind::kLip      ? Material::kLip
                              : t.kind == SkinKind::kInside ? Material::kMouthInside
                                                            : Material::kSkin;
    mesh.Triangle(material, t.corner[0], t.corner[1], t.corner[2]);
  }
  return slit;
}

std::size_t SkinFront::Cell(float mm) {
  return static_cast<std::size_t>(std::clamp(mm / kCellMm + kCells / 2, 0.0f, kCells - 1.0f));
}

SkinFront::SkinFront(const FineSkin& skin)
    : skin_(skin), cells_(static_cast<std::size_t>(kCells) * kCells) {
  constexpr float kBeyond = 0.1f;  // edges belong to both neighbours
  for (std::uint32_t i = 0; i < skin.triangles.size(); ++i) {
    const auto& t = skin.triangles[i];
    const glm::vec3 a = skin.position[t.corner[0]], b = skin.position[t.corner[1]],
                    c = skin.position[t.corner[2]];
    const glm::vec3 n = glm::cross(b - a, c - a);
    if (n.z <= 0 || a.z <= 20 || t.kind == SkinKind::kInside) continue;
    front_.push_back(i);
    const auto [left, right] = std::minmax({a.x, b.x, c.x});
    const auto [low, high] = std::minmax({a.y, b.y, c.y});
    for (std::size_t y = Cell(low - kBeyond); y <= Cell(high + kBeyond); ++y) {
      for (std::size_t x = Cell(left - kBeyond); x <= Cell(right + kBeyond); ++x) {
        cells_[y * kCells + x].push_back(i);
      }
    }
  }
}

glm::vec3 SkinFront::PointAt(glm::vec2 xy) const {
  glm::vec3 best(xy.x, xy.y, -1e9f);
  for (const std::uint32_t i : cells_[Cell(xy.y) * kCells + Cell(xy.x)]) {
    const auto& t = skin_.triangles[i].corner;
    const glm::vec3 a = skin_.position[t[0]], b = skin_.position[t[1]], c = skin_.position[t[2]];
    const glm::vec3 n = glm::cross(b - a, c - a);
    const float wb = ((xy.x - a.x) * (c.y - a.y) - (c.x - a.x) * (xy.y - a.y)) / n.z;
    const float wc = ((b.x - a.x) * (xy.y - a.y) - (xy.x - a.x) * (b.y - a.y)) / n.z;
    if (wb < -1e-4f || wc < -1e-4f || wb + wc > 1.0001f) continue;
    const float z = a.z + wb * (b.z - a.z) + wc * (c.z - a.z);
    best.z = std::max(best.z, z);
  }
  if (best.z > -1e8f) return best;

  glm::vec3 nearest(0);
  float least = 900;  // square of 30 mm
  for (const std::uint32_t i : front_) {
    const glm::vec3 a = skin_.position[skin_.triangles[i].corner[0]];
    const float d2 = (a.x - xy.x) * (a.x - xy.x) + (a.y - xy.y) * (a.y - xy.y);
    if (d2 >= least) continue;
    least = d2;
    nearest = a;
  }
  return nearest;
}

glm::vec2 SkinFront::UvAt(glm::vec2 xy, Side side) const {
  return Unroll(PointAt(xy) * glm::vec3(SignOf(side), 1, 1));
}

}  // namespace fsm
