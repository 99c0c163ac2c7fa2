#include "fsm/head/mouth_parts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <utility>
#include <vector>

#include "fsm/base/pi.h"
#include "fsm/base/smooth_step.h"
#include "fsm/head/paint_stream.h"

namespace fsm {
namespace {

/// Returns the point of an arch at an arc length from the median, found in small steps.
glm::vec3 AlongArch(const ToothArch& arch, float arc, float y) {
  float x = 0;
  float length = 0;
  const float side = arc < 0 ? -1.0f : 1.0f;
  while (length < std::abs(arc)) {
    const float slope = ArchSlope(arch, x);
    x += 0.25f / std::sqrt(1 + slope * slope);
    length += 0.25f;
  }
  return {side * x, y, step::ArchZ(arch, x)};
}

constexpr BakeWeights kWithTeeth{.follows = BakeWeights::Follows::kTeeth};

/// Builds one row of teeth and its gum.
class ToothRow {
 public:
  using TeethRow = std::array<float, 6>;
  struct Jaw {
    ToothArch arch;
    float upward;  // +1: crowns grow upward from the edge (upper jaw)
    Bone bone;
    TeethRow widths, heights, shorter;  // by tooth, from the median outward
    float light;                        // light on the central teeth
    glm::vec3 tooth;                    // enamel colour
  };
  ToothRow(Jaw jaw, const Identity& identity, MeshBuilder& mesh)
      : jaw_(std::move(jaw)),
        features_(*identity.features),
        gum_(identity.palette.gum),
        mesh_(mesh) {
    for (int c = -half(); c <= half(); ++c) columns_.push_back(ColumnAt(c));
  }

  void Add() {
    AddCrowns();
    AddGum();
  }

 private:
  void AddCrowns() {
    // Rows go from behind the incisal edge over the front of the crown to the gum.
    constexpr std::array kRows = {-0.5f, -0.15f, 0.0f, 0.1f, 0.3f, 0.55f, 0.8f, 1.0f};
    const auto first = static_cast<std::uint32_t>(mesh_.position.size());
    const auto depths = ListOf(features_.crown_depths);
    for (std::size_t r = 0; r < kRows.size(); ++r) {
      const float depth = r < depths.size() ? depths[r] : 0.0f;
      for (const Column& column : columns_) AddCrown(column, kRows[r], depth);
    }
    mesh_.Grid(Material::kTeeth, first, static_cast<int>(kRows.size()), Columns(), jaw_.upward > 0);
  }

  void AddGum() {
    constexpr std::array kRows = {0.96f, 1.1f, 1.6f};
    const auto bulge = ListOf(features_.gum_bulge);
    const auto first = static_cast<std::uint32_t>(mesh_.position.size());
    for (std::size_t r = 0; r < kRows.size(); ++r) {
      const float row = kRows[r];
      for (const Column& column : columns_) {
        const float back = std::abs(column.arc);
        const float scallop = row < 1 ? features_.gum_scallop * (1 - column.bump) : 0.0f;
        glm::vec3 p = FacePoint(column, row * column.height - scallop);
        p.z += bulge[r];
        mesh_.Add(p, gum_, features_.gum_light.At(SmoothStep(6, 34, back)), jaw_.bone, kWithTeeth);
      }
    }
    mesh_.Grid(Material::kGum, first, static_cast<int>(kRows.size()), Columns(), jaw_.upward > 0);
  }

  // Columns are denser where two teeth meet.
  static constexpr std::array kWithin = {0.0f, 0.12f, 0.31f, 0.5f, 0.69f, 0.88f};
  static constexpr int kPerTooth = kWithin.size();
  static constexpr int kCanine = 2;

  struct Column {
    int tooth;
    float arc, bump, height, shorter;
  };

  int count() const { return static_cast<int>(jaw_.widths.size()); }
  int half() const { return count() * kPerTooth; }
  int Columns() const { return static_cast<int>(columns_.size()); }

  Column ColumnAt(int signed_c) const {
    const int step = std::abs(signed_c);
    const int tooth = std::min(step / kPerTooth, count() - 1);
    const auto t = static_cast<std::size_t>(tooth);
    float arc = 0;
    for (std::size_t inner = 0; inner < t; ++inner) arc += jaw_.widths[inner];
    const int place = step - tooth * kPerTooth;
    const float within = place < kPerTooth ? kWithin[static_cast<std::size_t>(place)] : 1.0f;
    arc += within * jaw_.widths[t];
    // Canines are pointed; the others have round corners.
    const float off_middle = std::abs(2 * within - 1);
    const float corner = tooth == kCanine
                             ? features_.tooth_corners.canine * off_middle
                             : features_.tooth_corners.others * std::pow(off_middle, 4.0f);
    return {.tooth = tooth,
            .arc = signed_c < 0 ? -arc : arc,
            .bump = std::sqrt(std::max(0.0f, std::sin(kPi * within))),
            .height = jaw_.heights[t],
            .shorter = jaw_.shorter[t] + corner +
                       features_.tooth_uneven * (1 + NoiseAt(tooth, PaintStream::kToothLength,
                                                             static_cast<int>(jaw_.upward)))};
  }

  glm::vec3 FacePoint(const Column& column, float up) const {
    const float rise = features_.teeth_rise * std::abs(column.arc);
    return AlongArch(jaw_.arch, column.arc, jaw_.arch.edge_y + jaw_.upward * (up + rise));
  }

  /// `depth`: distance of the row behind the front.
  void AddCrown(const Column& column, float row, float depth) {
    const float up = row < -0.3f ? 0.6f * column.height
                     : row < 0   ? 0.3f + column.shorter
                               : row * column.height + column.shorter * SmoothStep(0.6f, 0.0f, row);
    glm::vec3 p = FacePoint(column, up);
    const float curve = features_.tooth_bulge.front *
                        std::sin(kPi * std::min(1.0f, 0.25f + std::max(row, 0.0f) * 0.75f));
    p.z += curve - depth - features_.tooth_bulge.between * (1 - column.bump);
    p.x *= 1 - 0.012f * depth;
    // Little light reaches the gaps between the teeth and the corners of the mouth.
    const float between = features_.light_between_teeth;
    const float crevice = between + (1 - between) * SmoothStep(0.0f, 0.75f, column.bump);
    const float dark = glm::mix(jaw_.light, features_.teeth_light.deep,
                                features_.teeth_light.fades.Ramp(std::abs(column.arc)));
    mesh_.Add(p, Enamel(column.tooth, row), crevice * dark * (row < -0.3f ? 0.4f : 1.0f), jaw_.bone,
              kWithTeeth);
  }

  /// Returns the colour of a tooth. Enamel is thin and grey at the edge and lets the warm dentine
  /// show through towards the gum, most in a canine; no two teeth have the same shade.
  glm::vec3 Enamel(int tooth, float row) const {
    const float warm = features_.dentine_shows.middle +
                       features_.dentine_shows.outward * static_cast<float>(tooth) +
                       (tooth == kCanine ? features_.dentine_shows.canine : 0.0f) +
                       features_.dentine_shows.gum * SmoothStep(0.35f, 1.0f, row);
    const glm::vec3 edge = glm::mix(glm::vec3(1), features_.enamel_edge_colour,
                                    tooth < kCanine ? SmoothStep(0.22f, 0.0f, row) : 0.0f);
    const float darkest = features_.tooth_shades;
    return jaw_.tooth * edge *
           (darkest + (1 - darkest) * NoiseAt(tooth, PaintStream::kToothShade)) *
           glm::mix(glm::vec3(1), features_.dentine_colour, std::min(warm, 1.0f));
  }

  const Jaw jaw_;
  const Features& features_;
  const glm::vec3 gum_;
  MeshBuilder& mesh_;
  std::vector<Column> columns_;  // from the agent's right to the left
};

}  // namespace

void BuildTeeth(const MouthAnatomy& mouth, const Identity& identity, MeshBuilder& mesh) {
  const Features& features = *identity.features;
  const glm::vec3 tooth = identity.palette.tooth;
  ToothRow(
      {mouth.upper_teeth(), 1, Bone::kSkull, features.upper_tooth_widths,
       features.upper_tooth_heights, features.upper_tooth_short, features.teeth_light.upper, tooth},
      identity, mesh)
      .Add();
  // The lower teeth are farther back, in the shade of the lip and of the upper row.
  const glm::vec3 shaded = tooth * features.lower_teeth_colour;
  ToothRow({mouth.lower_teeth(), -1, Bone::kJaw, features.lower_tooth_widths,
            features.lower_tooth_heights, features.lower_tooth_short, features.teeth_light.lower,
            shaded},
           identity, mesh)
      .Add();
}

void BuildTongue(const MouthAnatomy& mouth, const Identity& identity, MeshBuilder& mesh) {
  const Features& features = *identity.features;
  const Palette& palette = identity.palette;
  // A rounded back over a flat underside along the floor of the mouth. The row's number gives the
  // fraction of the way to the tip, which lies low behind the lower teeth.
  constexpr int kAlong = 17;
  constexpr int kAround = 20;
  const float tip_z = mouth.LineZ(0) - features.tongue_place.behind;
  const float base_y = mouth.LineY(0) - features.tongue_place.below;
  const float root_share = features.tongue_half_width.root;
  const auto first = static_cast<std::uint32_t>(mesh.position.size());
  for (int i = 0; i < kAlong; ++i) {
    const float share = static_cast<float>(i) / (kAlong - 1);  // 0 = root, 1 = tip
    const float taper = std::sqrt(std::max(0.0f, 1 - std::pow(share, 2.2f)));
    const float half_width =
        features.tongue_half_width.widest * taper * (root_share + (1 - root_share) * share) + 0.2f;
    const float height = features.tongue_half_height.root * taper *
                             (1 - features.tongue_half_height.flatter * share * share) +
                         0.1f;
    const float z = glm::mix(tip_z - features.tongue_length, tip_z, std::sin(share * kPi / 2));
    const float rise = features.tongue_rise.root * (1 - share) +
                       features.tongue_rise.middle * std::sin(kPi * share);
    for (int k = 0; k <= kAround; ++k) {
      const float around = 2 * kPi * static_cast<float>(k) / kAround;
      const float up = std::sin(around);
      const float groove = features.tongue_groove * taper * std::pow(std::max(0.0f, up), 12.0f);
      const glm::vec3 p(half_width * std::cos(around), base_y + rise + height * up - groove, z);
      // The teeth shade the sides, the palate shades the root. The underside of a raised tip is
      // visible, too.
      const float shown = std::max(SmoothStep(0, 1, up), 0.8f * SmoothStep(0.55f, 0.9f, share));
      const float lit = SmoothStep(-0.2f, 1.0f, share) * shown *
                        SmoothStep(0.8f, 0.2f, std::abs(std::cos(around)));
      BakeWeights weights;
      weights.skin.free = share;  // the tip bends, the root does not
      // The outline disappears in the dark of the mouth.
      const glm::vec3 colour = glm::mix(palette.mouth, palette.tongue, SmoothStep(0, 0.5f, lit));
      mesh.Add(p, colour, features.tongue_light.At(lit), Bone::kTongue, weights);
    }
  }
  mesh.Grid(Material::kTongue, first, kAlong, kAround + 1, true);
}

std::optional<Incisors> FindIncisors(std::span<const glm::vec3> rest, std::span<const Bone> bone,
                                     const HeadSurface& surface) {
  constexpr float kMiddle = 3;  // millimetres to either side of the median
  Incisors found;
  std::array<float, 3> best = {1e9f, 1e9f, 1e9f};
  const auto keep = [&best](std::size_t which, float y, std::uint32_t i, std::uint32_t& vertex) {
    if (y >= best[which]) return;
    best[which] = y;
    vertex = i;
  };
  for (const auto& part : surface.parts) {
    if (part.material != Material::kTeeth) continue;
    for (const std::uint32_t i : surface.Corners(part)) {
      const glm::vec3 p = rest[i];
      if (std::abs(p.x) > kMiddle) continue;
      if (bone[i] == Bone::kJaw) {
        keep(1, -p.y, i, found.lower);
      } else {
        keep(0, p.y, i, found.upper);
        keep(2, -p.y, i, found.upper_root);
      }
    }
  }
  return found.upper == found.lower ? std::nullopt : std::optional(found);
}

}  // namespace fsm
