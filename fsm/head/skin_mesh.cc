#include "fsm/head/skin_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "fsm/head/paint.h"

namespace fsm {
namespace {

// Columns of the half face; 16.4 and 46.6 are the corners of the eye, 25 that of the mouth.
constexpr std::array kColumns = {0.0f,  1.6f,  3.6f,  5.6f,  7.6f,  9.6f,  11.8f, 14.2f, 16.4f,
                                 18.6f, 21.0f, 23.0f, 25.0f, 27.2f, 29.6f, 32.0f, 34.4f, 37.0f,
                                 39.6f, 42.2f, 44.6f, 46.6f, 49.0f, 52.0f, 56.0f, 61.0f, 67.0f,
                                 74.0f, 82.0f, 92.0f, 105.f, 120.f, 140.f, 160.f, 180.f, 200.f};
constexpr int kHalf = static_cast<int>(kColumns.size()) - 1;
constexpr int kAll = 2 * kHalf + 1;

// Farther than this from the ball's centre, sideways, flesh fills the corner between the lids.
constexpr float kBesideBall = 10.2f;

enum class RowKind { kPlain, kUpperLid, kLowerLid, kNose, kUpperLip, kLowerLip, kChin, kCloth };

/// One row; `value` is b (plain), the distance from the lid's edge, the part of the way (nose,
/// chin), or the place on the lip: 0 seam, 1 border, above 1 millimetres beyond the border + 1.
struct Row {
  RowKind kind;
  float value;
};

std::vector<Row> MakeRows() {
  std::vector<Row> rows;
  const auto add = [&](RowKind kind, std::initializer_list<float> values) {
    for (const float v : values) rows.push_back({kind, v});
  };
  add(RowKind::kPlain, {136, 128, 118, 107, 97, 87, 78, 70, 63});
  add(RowKind::kUpperLid,
      {26, 21.5f, 17.5f, 14.3f, 11.6f, 9.3f, 7.4f, 6, 4.8f, 3.8f, 2.6f, 1.3f, 0});
  add(RowKind::kLowerLid, {0, 1.2f, 2.6f, 4.2f, 6.2f, 8.6f, 11.4f});
  add(RowKind::kNose, {.10f, .20f, .30f, .39f, .48f, .56f, .63f, .70f, .76f, .82f, .88f, .94f});
  add(RowKind::kUpperLip, {8, 5.5f, 3.5f, 2.1f, 1, .78f, .56f, .34f, .15f, 0});
  add(RowKind::kLowerLip, {0, .14f, .32f, .52f, .74f, 1, 2.3f, 4, 6.5f});
  add(RowKind::kChin, {.17f, .34f, .5f, .66f, .83f});
  add(RowKind::kPlain,
      {-80, -84, -87.5f, -91, -95, -101, -108, -116, -125, -137, -150, -161, -172, -182});
  add(RowKind::kCloth, {-171, -176, -184, -194, -206, -220, -240, -265, -290});
  return rows;
}

class SkinBuilder {
 public:
  SkinBuilder(const FaceSurface& surface, const EyeAnatomy& eye, const MouthAnatomy& mouth,
              HeadMesh& mesh)
      : surface_(surface), eye_(eye), mouth_(mouth), mesh_(mesh), rows_(MakeRows()) {}

  SkinMap Build() {
    ids_.resize(rows_.size(), std::vector<std::uint32_t>(kAll));
    for (std::size_t r = 0; r < rows_.size(); ++r) {
      for (int c = 0; c < kAll; ++c) ids_[r][Index(c)] = MakeVertex(r, c);
    }
    for (std::size_t r = 0; r + 1 < rows_.size(); ++r) AddQuads(r);
    AddLidRims();
    AddMouthInside();
    map_.corner_left = ids_[SeamRow()][Index(kHalf + MouthCorner())];
    map_.corner_right = ids_[SeamRow()][Index(kHalf - MouthCorner())];
    map_.vertex_count = static_cast<std::uint32_t>(mesh_.position.size());
    return map_;
  }

 private:
  static std::size_t Index(int c) { return static_cast<std::size_t>(c); }
  static float Column(int c) {
    const int half = c - kHalf;
    return half < 0 ? -kColumns[Index(-half)] : kColumns[Index(half)];
  }
  static int MouthCorner() {
    return static_cast<int>(std::ranges::find(kColumns, 25.0f) - kColumns.begin());
  }
  std::size_t FirstOf(RowKind kind) const {
    return static_cast<std::size_t>(std::ranges::find(rows_, kind, &Row::kind) - rows_.begin());
  }
  std::size_t SeamRow() const { return FirstOf(RowKind::kLowerLip); }
  std::size_t LidRow() const { return FirstOf(RowKind::kLowerLid); }
  bool InEyeSlit(float a) const { return a > eye_.inner_x() + 0.1f && a < eye_.outer_x() - 0.1f; }

  // The line between the lids, continued to the median and the temple.
  float LidEdge(bool upper, float a) const {
    if (a < eye_.inner_x()) {
      return eye_.UpperY(a) + 1.5f * (1 - a / eye_.inner_x());
    }
    return upper ? eye_.UpperY(a) : eye_.LowerY(a);
  }

  float RowY(const Row& row, float a) const {
    const float corner = SmoothStep(19, 25, a) + 0.06f * std::max(0.0f, a - 25);
    switch (row.kind) {
      case RowKind::kPlain:
      case RowKind::kCloth:
        return row.value;
      case RowKind::kUpperLid: {
        // Beyond the corners the rows have room to spread.
        const float out = std::max(0.0f, std::max(eye_.inner_x() - a, a - eye_.outer_x()));
        return LidEdge(true, a) + row.value + std::min(1.0f, out / 18) * std::min(3.0f, row.value);
      }
      case RowKind::kLowerLid: {
        const float out = std::max(0.0f, std::max(eye_.inner_x() - a, a - eye_.outer_x()));
        return LidEdge(false, a) - row.value - std::min(1.0f, out / 18) * std::min(3.0f, row.value);
      }
      case RowKind::kNose:
        return glm::mix(RowY({RowKind::kLowerLid, 11.4f}, a), RowY({RowKind::kUpperLip, 8}, a),
                        row.value);
      case RowKind::kUpperLip: {
        const float part = std::min(row.value, 1.0f);
        const float skin = std::max(0.0f, row.value - 1);
        return mouth_.LineY(a) + mouth_.BorderY(1, a) * part + skin + part * corner * 1.6f;
      }
      case RowKind::kLowerLip: {
        const float part = std::min(row.value, 1.0f);
        const float skin = std::max(0.0f, row.value - 1);
        return mouth_.LineY(a) + mouth_.BorderY(-1, a) * part - skin - part * corner * 1.6f;
      }
      case RowKind::kChin:
        return glm::mix(RowY({RowKind::kLowerLip, 6.5f}, a), -80.0f, row.value);
    }
    return 0;
  }

  // How far the lips' border stands off the plain surface, faded into the skin around.
  float LipLift(float a, float y) const {
    const float x = std::min(a, mouth_.corner().x);
    const float line = mouth_.LineY(x);
    const int side = y >= line ? 1 : -1;
    glm::vec2 ignored;
    const glm::vec3 border = mouth_.Red(side, x, 1);
    const float lift = border.z - surface_.PointAt({border.x, border.y}, ignored).z;
    const float dx = a - x;
    const float dy = std::max(0.0f, static_cast<float>(side) * (y - border.y));
    return lift * (1 - SmoothStep(0, 11, std::sqrt(dx * dx + dy * dy)));
  }

  std::uint32_t MakeVertex(std::size_t r, int c) {
    const Row& row = rows_[r];
    const float signed_a = Column(c);
    const float a = std::abs(signed_a);
    // The same point again: pole, back seam, and slit rows outside their slits.
    if (c == kAll - 1) return ids_[r][0];
    if (r == 0 && c > 0) return ids_[0][0];
    if (r == LidRow() && !InEyeSlit(a)) return ids_[r - 1][Index(c)];
    if (r == SeamRow() && a >= mouth_.corner().x) return ids_[r - 1][Index(c)];

    const bool lip_row = row.kind == RowKind::kUpperLip || row.kind == RowKind::kLowerLip;
    const int lip_side = row.kind == RowKind::kUpperLip ? 1 : -1;
    const float y = RowY(row, a);
    glm::vec2 domain(a, y);
    glm::vec3 p;
    if (lip_row && row.value <= 1 && a < mouth_.corner().x) {
      p = mouth_.Red(lip_side, a, row.value);
      p.y += row.value * 1.6f * SmoothStep(19, 25, a) * static_cast<float>(lip_side) * 0.6f;
    } else if (row.kind != RowKind::kPlain && row.kind != RowKind::kCloth && a < 62) {
      glm::vec2 solved;
      const glm::vec3 exact = surface_.PointAt({a, y}, solved);
      // Towards the jaw the rows slope with its edge, as the domain does.
      const bool low = lip_row || row.kind == RowKind::kChin;
      const float sides = row.kind == RowKind::kNose ? row.value : low ? 1.0f : 0.0f;
      const float part = glm::mix(SmoothStep(62, 50, a), SmoothStep(46, 28, a), sides) *
                         (row.kind == RowKind::kChin ? 1 - row.value : 1.0f);
      domain = glm::mix(domain, solved, part);
      p = part >= 1 ? exact : surface_.Point(domain);
      if (y < -18 && y > -68 && a < 40) p.z += LipLift(a, y);
    } else {
      p = surface_.Point(domain);
    }

    Flesh flesh = FleshAt({signed_a, y}, FleshSide(r, a), mouth_.LineY(std::min(a, 25.0f)));
    FitLid(row, a, y, p, flesh);
    if (p.x != 0 && signed_a < 0) p.x = -p.x;
    if (flesh.eye != 0) flesh.eye = signed_a < 0 ? std::int8_t{-1} : std::int8_t{1};
    if (lip_row || row.kind == RowKind::kNose || row.kind == RowKind::kChin) {
      TieToSeam(row, lip_side, a, y, c, flesh);
    }
    Paint paint = SkinPaint({a, y}, eye_);
    if (lip_row && a <= mouth_.corner().x) PaintLip(row, a, paint);
    if (row.kind == RowKind::kCloth) {
      p += DressLift(row) * surface_.Normal({signed_a, row.value});
      paint = {palette::kCloth * (1 + 0.05f * Grain(c, static_cast<int>(r))), 1};
      if (&row == &rows_[FirstOf(RowKind::kCloth)]) paint.open = 0.75f;
    }
    return mesh_.Add(p, paint.albedo, paint.open, Bone::kFlesh, flesh);
  }

  static float DressLift(const Row& row) { return row.value > -172 ? 1.2f : 2.6f; }

  int FleshSide(std::size_t r, float a) const {
    if (a >= mouth_.corner().x) return 0;
    return r < SeamRow() ? 1 : -1;
  }

  // Puts the vertices about the eye on the surface the lids turn on.
  void FitLid(const Row& row, float a, float y, glm::vec3& p, Flesh& flesh) const {
    const bool upper = row.kind == RowKind::kUpperLid;
    if (!upper && row.kind != RowKind::kLowerLid) return;
    if (a < eye_.inner_x() - 6 || a > eye_.outer_x() + 8) return;
    const float radius = eye_.LidRadius(a);
    const float dy = y - eye_.centre().y;
    const bool slit = a >= eye_.inner_x() - 0.1f && a <= eye_.outer_x() + 0.1f;
    if (std::abs(dy) < radius) {
      const float lid_z = eye_.LidAxisZ(a) + std::sqrt(radius * radius - dy * dy);
      const float corner = std::max(0.0f, std::max(eye_.inner_x() - a, a - eye_.outer_x()));
      const float near =
          SmoothStep(upper ? 7.5f : 6.5f, 2.5f, row.value) * SmoothStep(6, 0, corner);
      p.z = glm::mix(p.z, lid_z, near);
    }
    if (!slit) {
      flesh.free = SmoothStep(0, 9, row.value + std::max(eye_.inner_x() - a, a - eye_.outer_x()));
      return;
    }
    flesh.eye = 1;
    const float hold = upper ? 1 - SmoothStep(0, 12, row.value) : 1 - SmoothStep(0, 10, row.value);
    (upper ? flesh.lid_upper : flesh.lid_lower) = hold;
    flesh.free = 1 - hold;
    if (upper) {
      // A shallow fold where the lid folds under the brow's skin.
      const float ends = SmoothStep(eye_.inner_x(), eye_.inner_x() + 6, a) *
                         SmoothStep(eye_.outer_x() + 1, eye_.outer_x() - 4, a);
      const float d = row.value - 3.8f;
      p.z += ends *
             (-1.0f * std::exp(-d * d / 0.8f) + 0.8f * std::exp(-(d - 2.0f) * (d - 2.0f) / 2.5f));
      // Skin that a closing lid draws over the ball must clear it, cornea included.
      const float depth = p.z - eye_.LidAxisZ(a);
      const float clear = eye_.InnerRadius(a) + 0.75f;
      const float now = std::sqrt(dy * dy + depth * depth);
      if (now < clear) p.z = eye_.LidAxisZ(a) + std::sqrt(std::max(0.0f, clear * clear - dy * dy));
    }
  }

  // Lip vertices, and in lesser part the skin around, follow what their column's seam is corrected
  // by.
  void TieToSeam(const Row& row, int side, float a, float y, int c, Flesh& flesh) const {
    if (a >= mouth_.corner().x) return;
    float weight = 1;
    if (row.kind == RowKind::kUpperLip || row.kind == RowKind::kLowerLip) {
      weight = row.value <= 1 ? 1.0f - 0.12f * row.value : 0.88f * SmoothStep(15, 0, row.value - 1);
    } else {
      const float border = mouth_.LineY(a) + mouth_.BorderY(row.kind == RowKind::kNose ? 1 : -1, a);
      weight = 0.88f * SmoothStep(15, 0, std::abs(y - border));
      side = row.kind == RowKind::kNose ? 1 : -1;
    }
    flesh.lip_column = static_cast<std::int16_t>(c - (kHalf - MouthCorner()) - 1);
    flesh.lip_weight = weight * static_cast<float>(side);
  }

  void PaintLip(const Row& row, float a, Paint& paint) const {
    const float fade = SmoothStep(25.2f, 21, a) * 0.7f + 0.3f;
    const float red = row.value < 1 ? 1.0f : row.value == 1 ? 0.6f : 0.0f;
    paint.albedo = glm::mix(paint.albedo, palette::kLip, red * fade);
    if (row.value < 0.3f) {
      paint.albedo = glm::mix(paint.albedo, palette::kLipInside, 1 - row.value / 0.3f);
      paint.open *= 0.6f + 0.4f * row.value / 0.3f;
    }
  }

  void AddQuads(std::size_t r) {
    const RowKind kind = rows_[r].kind;
    if (kind != RowKind::kCloth && rows_[r + 1].kind == RowKind::kCloth) return;
    for (int c = 0; c + 1 < kAll; ++c) {
      const float a = std::max(std::abs(Column(c)), std::abs(Column(c + 1)));
      const float inner = std::min(std::abs(Column(c)), std::abs(Column(c + 1)));
      if (r + 1 == SeamRow() && inner < mouth_.corner().x) continue;
      if (r + 1 == LidRow() && a > eye_.inner_x() + 0.1f && inner < eye_.outer_x() - 0.1f) continue;
      const auto& top = ids_[r];
      const auto& low = ids_[r + 1];
      // The scalp never shows under the hair.
      const float height = mesh_.position[low[Index(c)]].y;
      if (height > 108 || (inner >= 92 && height > -20)) continue;
      const bool red = (kind == RowKind::kUpperLip && rows_[r].value <= 1) ||
                       (kind == RowKind::kLowerLip && rows_[r + 1].value <= 1);
      const Material material = kind == RowKind::kCloth         ? Material::kCloth
                                : red && a <= mouth_.corner().x ? Material::kLip
                                                                : Material::kSkin;
      mesh_.Quad(material, top[Index(c)], low[Index(c)], low[Index(c + 1)], top[Index(c + 1)]);
    }
  }

  void AddLidRims() {
    for (const int side : {-1, 1}) {
      std::vector<std::pair<float, std::uint32_t>> wet_edge;  // of the upper lid: x, vertex
      for (const bool upper : {true, false}) {
        const std::size_t edge_row = upper ? LidRow() - 1 : LidRow();
        std::vector<std::uint32_t> previous;
        int columns = 0;
        float previous_a = 0;
        for (int c = 0; c < kAll; ++c) {
          const float a = std::abs(Column(c));
          if (Column(c) * static_cast<float>(side) <= 0) continue;
          if (a < eye_.inner_x() - 0.1f || a > eye_.outer_x() + 0.1f) continue;
          std::vector<std::uint32_t> line = {ids_[edge_row][Index(c)]};
          const float angle = upper ? eye_.UpperAngle(a) : eye_.LowerAngle(a);
          const float tuck = upper ? 0.45f : -0.45f;
          Flesh flesh = mesh_.flesh[line[0]];
          flesh.free = 0;
          (upper ? flesh.lid_upper : flesh.lid_lower) = 1;
          const std::array<glm::vec3, 2> points = {
              eye_.OnLid(a, angle, eye_.InnerRadius(a)),
              eye_.OnLid(a, angle + tuck, eye_.InnerRadius(a) - 0.05f)};
          for (std::size_t k = 0; k < points.size(); ++k) {
            glm::vec3 p = points[k];
            p.x *= static_cast<float>(side);
            line.push_back(
                mesh_.Add(p, palette::kRim, k == 0 ? 0.72f : 0.35f, Bone::kFlesh, flesh));
          }
          if (upper) {
            wet_edge.emplace_back(a, line[1]);
          } else if (!previous.empty()) {
            // Beside the ball the corners are filled between the lids (the tear duct's flesh).
            const auto at = static_cast<std::size_t>(columns);
            const float mid = 0.5f * (wet_edge[at].first + wet_edge[at - 1].first);
            if (std::abs(mid - eye_.centre().x) > kBesideBall) {
              mesh_.Quad(Material::kSkin, wet_edge[at - 1].second, previous[1], line[1],
                         wet_edge[at].second);
            }
          }
          ++columns;
          // Where the corner is filled nothing lies behind the wet edge.
          const bool filled = std::abs(0.5f * (a + previous_a) - eye_.centre().x) > kBesideBall;
          previous_a = a;
          for (std::size_t k = 0; !previous.empty() && k + 1 < line.size(); ++k) {
            if (k > 0 && filled) continue;
            if (upper) {
              mesh_.Quad(Material::kSkin, previous[k], previous[k + 1], line[k + 1], line[k]);
            } else {
              mesh_.Quad(Material::kSkin, previous[k], line[k], line[k + 1], previous[k + 1]);
            }
          }
          previous = line;
        }
      }
    }
  }

  // Inside of the lips and a dark sock behind them, wider than the teeth.
  void AddMouthInside() {
    struct Ring {
      float height, back, widen;  // from the seam: up (or down), backwards, sideways
    };
    constexpr std::array kRings = {Ring{0.8f, 2.0f, 1}, Ring{3.0f, 4.2f, 1}, Ring{8, 6.0f, 1.04f},
                                   Ring{13, 14, 1.16f}, Ring{14, 30, 1.22f}, Ring{12, 46, 1.1f},
                                   Ring{7, 58, 0.8f},   Ring{0, 62, 0.5f}};
    const int corner = MouthCorner();
    for (const int side : {1, -1}) {
      const std::size_t seam_row = side > 0 ? SeamRow() - 1 : SeamRow();
      std::vector<std::uint32_t> previous;
      for (int c = kHalf - corner; c <= kHalf + corner; ++c) {
        const std::uint32_t seam = ids_[seam_row][Index(c)];
        const float a = std::abs(Column(c));
        const float open = std::sqrt(std::max(0.0f, 1 - a * a / (25.0f * 25.0f)));
        if (c > kHalf - corner && c < kHalf + corner) {
          const auto column = Index(c - (kHalf - corner) - 1);
          map_.seam.resize(std::max(map_.seam.size(), column + 1));
          (side > 0 ? map_.seam[column].first : map_.seam[column].second) = seam;
          if (c == kHalf) map_.mid_column = static_cast<std::uint32_t>(column);
        }
        std::vector<std::uint32_t> line = {seam};
        for (std::size_t k = 0; k < kRings.size(); ++k) {
          const Ring& ring = kRings[k];
          glm::vec3 p = mesh_.position[seam];
          const float deep = static_cast<float>(k) / static_cast<float>(kRings.size() - 1);
          p.x *= glm::mix(std::min(ring.widen, 1.0f), ring.widen, std::min(1.0f, 2 * open));
          p.y += static_cast<float>(side) * ring.height * (k < 2 ? open : 0.1f + 0.9f * open);
          p.z -= ring.back * (0.9f + 0.1f * open);
          Flesh flesh = mesh_.flesh[seam];
          if (flesh.lip_column < 0) flesh.lip_weight = 0;
          flesh.lip_weight *= k < 2 ? 1.0f : std::max(0.0f, 1 - 3 * deep);
          flesh.free *= std::max(0.0f, 1 - (2.5f - 1.6f * (1 - open)) * deep);
          flesh.jaw = glm::mix(flesh.jaw, side > 0 ? 0.0f : 0.9f, deep * open);
          const glm::vec3 colour =
              glm::mix(palette::kLipInside, palette::kMouth, SmoothStep(0.05f, 0.4f, deep));
          line.push_back(
              mesh_.Add(p, colour, 0.6f * (1 - deep) * (1 - deep) + 0.06f, Bone::kFlesh, flesh));
        }
        for (std::size_t k = 0; !previous.empty() && k + 1 < line.size(); ++k) {
          const Material material = k < 2 ? Material::kLip : Material::kMouthInside;
          if (side > 0) {
            mesh_.Quad(material, previous[k], previous[k + 1], line[k + 1], line[k]);
          } else {
            mesh_.Quad(material, previous[k], line[k], line[k + 1], previous[k + 1]);
          }
        }
        previous = line;
      }
    }
  }

  const FaceSurface& surface_;
  const EyeAnatomy& eye_;
  const MouthAnatomy& mouth_;
  HeadMesh& mesh_;
  std::vector<Row> rows_;
  std::vector<std::vector<std::uint32_t>> ids_;
  SkinMap map_;
};

}  // namespace

SkinMap BuildSkin(const FaceSurface& surface, const EyeAnatomy& eye, const MouthAnatomy& mouth,
                  HeadMesh& mesh) {
  return SkinBuilder(surface, eye, mouth, mesh).Build();
}

}  // namespace fsm
