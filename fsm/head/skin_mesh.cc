#include "fsm/head/skin_mesh.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <optional>

#include "fsm/base/number_table.h"
#include "fsm/base/smooth_step.h"
#include "fsm/head/hair_parts.h"
#include "fsm/head/landmarks.h"
#include "fsm/head/paint.h"

namespace fsm {
namespace {

float Sign(float v) { return v > 0 ? 1.0f : v < 0 ? -1.0f : 0.0f; }

/// Returns twice the cage's column; signed, 0 at the median.
int FineColumn(const CageTag& tag, float x) {
  return static_cast<int>(std::lround(2 * tag.lip_column * Sign(x)));
}

constexpr int kLastColumn = 2 * kLipColumns - 1;

/// Computes the weights that depend only on the position on the face. `lip`: the side of the
/// mouth's slit that it is on; none where the cheek joins both. `line_y`: the height of that line.
SkinWeights SkinWeightsAt(glm::vec2 domain, std::optional<Lip> lip, float corner_x, float line_y,
                          const Features& features) {
  const auto& jaw = features.skin_jaw;
  SkinWeights weights;
  weights.domain = domain;
  const float a = std::abs(domain.x);
  const float below = line_y - domain.y;  // millimetres below the line of the mouth
  const float beyond = std::max(0.0f, a - corner_x);

  // Along the slit the lower lip follows the jaw fully at the median, the upper lip hardly, and the
  // corner almost by half; both reach it along a quarter of an oval. After ICT-FaceKit's jawOpen:
  // the upper lip moves 7 % as far as the lower at the median, 10 % at 10 mm, 18 % at 16 mm, 26 %
  // at 20 mm, the corner 43 %; the lower lip 88 % at 10 mm, 75 % at 18 mm.
  const float end = corner_x - jaw.lips_end;  // beyond, the lips stay together
  const float apart = std::sqrt(std::max(0.0f, 1 - a * a / (end * end)));
  const float upper_seam = jaw.upper_seam.At(1 - std::pow(apart, 1.4f));
  const float lower_seam = upper_seam + (1 - upper_seam) * apart;
  const float joins = jaw.joins.At(beyond);
  const float along_slit = !lip ? 1.0f : 1 - SmoothStep(corner_x, corner_x - jaw.slit_end, a);
  if (lip == Lip::kLower || (!lip && below > 0)) {
    weights.jaw = lower_seam + (1 - lower_seam) * SmoothStep(0, jaw.below.At(beyond), below);
    weights.above_mouth =
        jaw.joined * along_slit * (1 - SmoothStep(0, lip ? jaw.joins_lip : joins, below));
  } else {
    weights.jaw = upper_seam * (1 - SmoothStep(0, jaw.above.At(beyond), -below));
    weights.above_mouth = 1 - jaw.joined * along_slit * (1 - SmoothStep(0, joins, -below));
  }
  // The skin of the jaw ends at the throat and in front of the ear.
  weights.jaw *= jaw.throat.Ramp(domain.y) * jaw.ear.Ramp(a);
  return weights;
}

/// Returns the lip that holds a point; none at the corners and away from the mouth.
std::optional<Lip> LipOf(const CageTag& tag) {
  if ((tag.lip_hold <= 0 && tag.deep <= 0) || tag.upper_lip == 0) return std::nullopt;
  return tag.upper_lip > 0 ? Lip::kUpper : Lip::kLower;
}

BakeWeights MakeSkinWeights(const CageTag& tag, glm::vec3 p, const MouthAnatomy& mouth,
                            const Features& features) {
  const float a = std::abs(p.x);
  const float corner_x = mouth.corner().x;
  const auto& hold = features.skin_hold;
  const auto& bag = features.bag_hold;
  // At the side of the head distances along the skin exceed those in the frontal view.
  const float round = a + hold.rounds * std::max(0.0f, hold.rounds_from_z - p.z);
  glm::vec2 domain(p.x < 0 ? -round : round, p.y);
  const float line_y = mouth.LineY(std::min(a, corner_x));
  if (tag.deep > 0) domain.y = line_y;
  BakeWeights weights{.skin = SkinWeightsAt(domain, LipOf(tag), corner_x, line_y, features)};
  weights.skin.free = hold.free_z.Ramp(p.z);
  weights.skin.neck = NeckWeight(p.y - hold.nape_slope * std::max(0.0f, hold.nape_z - p.z));
  if (tag.eye > 0) {
    weights.eye = p.x < 0 ? Side::kRight : Side::kLeft;
    weights.lid_upper = tag.lid_upper;
    weights.lid_lower = tag.lid_lower;
    weights.skin.free = std::max(0.0f, 1 - hold.lids * tag.eye);
  }
  const int column = FineColumn(tag, p.x);
  if (tag.lip_hold > 0 && std::abs(column) <= kLastColumn && tag.upper_lip != 0) {
    weights.lip_column = static_cast<std::int16_t>(column + kLastColumn);
    weights.lip_weight = tag.lip_hold * Sign(tag.upper_lip);
  }
  weights.by_teeth = (tag.red >= 0 || tag.lip_hold >= hold.by_teeth) && tag.deep < bag.past_teeth;
  if (tag.deep > 0) {
    const float open = std::sqrt(std::max(0.0f, 1 - a * a / (corner_x * corner_x)));
    weights.skin.free *= std::max(0.0f, 1 - (bag.held - bag.less_aside * (1 - open)) * tag.deep);
    const float rigid = tag.upper_lip >= 0 ? 0.0f : bag.lower_jaw;
    weights.skin.jaw = glm::mix(weights.skin.jaw, rigid,
                                bag.jaw_over.Ramp(tag.deep) * std::abs(Sign(tag.upper_lip)));
    if (tag.deep > bag.end) weights.skin.jaw = bag.end_jaw;
  }
  return weights;
}

PaintedSkin MakePaint(const CageTag& tag, glm::vec3 p, SkinKind kind, const SkinPainter& painter,
                      const Identity& identity) {
  const Features& features = *identity.features;
  const Palette& palette = identity.palette;
  PaintedSkin paint = painter.At(p);
  if (tag.deep > 0) {
    paint.albedo =
        glm::mix(palette.lip_inside, palette.mouth, features.skin_paint.dark_inside.Ramp(tag.deep));
    const float out = 1 - tag.deep;
    const Linear light = features.mouth_light;
    paint.openness = light.start + light.added * out * out;
    return paint;
  }
  if (tag.red >= 0 && kind == SkinKind::kLip) {
    const float aside = std::abs(p.x);
    const float reddened = features.lip_red.middle * features.skin_paint.red_edge.Ramp(tag.red) *
                           (1 - features.lip_red.less_aside * features.lip_red.aside.Ramp(aside));
    paint.albedo = glm::mix(paint.albedo, palette.lip, reddened);
    // The edge of the red is soft; the middle of the lips is wet.
    const float wet = features.skin_paint.wet.Ramp(tag.red) *
                      (1 - features.lip_wet.less_aside * features.lip_wet.aside.Ramp(aside));
    paint.albedo = glm::mix(paint.albedo, palette.lip_inside, features.lip_wet.middle * wet);
    paint.openness *= 1 - features.lip_wet.shade * wet;
    // The corners lie deep.
    paint.openness *= 1 - features.lip_corner.shade * features.lip_corner.aside.Ramp(aside);
    // The lower lip rolls into the mouth, so its edge is in its own shade.
    if (tag.upper_lip < 0)
      paint.openness *=
          1 - features.lip_wet.lower_edge * features.skin_paint.lower_edge.Ramp(tag.red);
  }
  if (tag.hole > 0) {
    paint.albedo =
        glm::mix(paint.albedo, features.nostril_colour, features.nostril_dark.colour * tag.hole);
    paint.openness *= 1 - features.nostril_dark.shade * tag.hole;
  }
  if (tag.margin >= 0 && tag.margin < features.skin_paint.lid_rim_mm) {
    const glm::vec3 wet = palette.lid_rim * glm::mix(1.0f, features.lid_rim.upper, tag.lid_upper);
    paint.albedo = glm::mix(paint.albedo, wet, features.lid_rim.colour);
    paint.openness *= features.lid_rim.light;
  }
  return paint;
}

}  // namespace

MouthVertices BuildSkin(const FineSkin& skin, const EyeAnatomy& eye, const MouthAnatomy& mouth,
                        const Identity& identity, MeshBuilder& mesh) {
  const SkinPainter painter(identity, eye);
  const HairLook hair(identity);
  std::vector<SkinKind> kind(skin.position.size(), SkinKind::kSkin);
  for (const FineSkin::Triangle& t : skin.triangles) {
    for (const std::uint32_t v : t.corner) kind[v] = std::max(kind[v], t.kind);
  }
  MouthVertices found;
  found.seam.resize(2 * kLastColumn + 1);
  found.corners.emplace();
  for (std::uint32_t v = 0; v < skin.position.size(); ++v) {
    const glm::vec3 p = skin.position[v];
    const CageTag& tag = skin.tag[v];
    const PaintedSkin paint = MakePaint(tag, p, kind[v], painter, identity);
    mesh.Add(p, paint.albedo, paint.openness, Bone::kSkin,
             MakeSkinWeights(tag, p, mouth, *identity.features));
    if (tag.seam < 1) continue;
    const int column = FineColumn(tag, p.x);
    if (std::abs(column) > kLastColumn) {
      (p.x > 0 ? found.corners->left : found.corners->right) = v;
    } else {
      auto& pair = found.seam[static_cast<std::size_t>(column + kLastColumn)];
      (tag.upper_lip > 0 ? pair.first : pair.second) = v;
    }
  }
  for (const FineSkin::Triangle& t : skin.triangles) {
    const auto covered = [&](std::uint32_t v) {
      return hair.AboveHairline(skin.position[v]) > identity.features->skin_paint.hidden_beyond;
    };
    if (std::ranges::all_of(t.corner, covered)) continue;
    const Material material = t.kind == SkinKind::kLip      ? Material::kLip
                              : t.kind == SkinKind::kInside ? Material::kMouthInside
                                                            : Material::kSkin;
    mesh.Triangle(material, t.corner[0], t.corner[1], t.corner[2]);
  }
  return found;
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
  return SkinUv(PointAt(xy) * glm::vec3(SignOf(side), 1, 1));
}

}  // namespace fsm
