#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <numbers>
#include <span>
#include <vector>

#include "fsm/base/grain.h"
#include "fsm/head/paint.h"
#include "fsm/head/parts.h"

namespace fsm {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;

// Widths of the teeth from the median outward, upper and lower, and heights of the crowns.
constexpr std::array kUpperWidth = {8.4f, 6.6f, 7.5f, 6.8f, 6.6f, 9.6f};
constexpr std::array kUpperHeight = {10.2f, 9.2f, 9.9f, 8.6f, 8.0f, 7.4f};
constexpr std::array kLowerWidth = {5.3f, 5.8f, 6.8f, 7.0f, 7.2f, 10.4f};
constexpr std::array kLowerHeight = {8.8f, 9.0f, 9.6f, 8.4f, 8.0f, 7.4f};
// How far their edges stay behind those of the longest, which makes a row look grown.
constexpr std::array kUpperShort = {0.0f, 0.45f, 0.1f, 0.6f, 0.9f, 1.0f};
constexpr std::array kLowerShort = {0.1f, 0.0f, 0.1f, 0.5f, 0.8f, 0.9f};

/// The point of an arch at an arc length from the median, followed in small steps.
glm::vec3 AlongArch(const ToothArch& arch, float arc, float y) {
  float x = 0;
  float length = 0;
  const float side = arc < 0 ? -1.0f : 1.0f;
  while (length < std::abs(arc)) {
    const float slope = arch.Slope(x);
    x += 0.25f / std::sqrt(1 + slope * slope);
    length += 0.25f;
  }
  return {side * x, y, arch.At(x)};
}

struct Jaw {
  ToothArch arch;
  float upward;  // +1: crowns grow upwards from the edge (upper jaw)
  Bone bone;
};

struct Crowns {
  std::span<const float> widths, heights, shorts;
};

/// Enamel is thin and grey at the edge and lets the warm dentine through towards the gum, most in a
/// canine; no two teeth are of one shade.
glm::vec3 Enamel(const Palette& palette, int tooth, float shade, float row) {
  const float warm = 0.25f + 0.1f * static_cast<float>(tooth) + (tooth == 2 ? 0.25f : 0.0f) +
                     0.6f * SmoothStep(0.35f, 1.0f, row);
  const glm::vec3 edge = glm::mix(glm::vec3(1), glm::vec3(0.86f, 0.90f, 0.94f),
                                  tooth < 2 ? SmoothStep(0.22f, 0.0f, row) : 0.0f);
  return palette.tooth * edge * (0.97f + 0.03f * shade) *
         glm::mix(glm::vec3(1), glm::vec3(0.96f, 0.90f, 0.78f), std::min(warm, 1.0f));
}

void AddArch(const Jaw& jaw, const Crowns& crowns, const Palette& palette, HeadMesh& mesh) {
  // Closer together where two teeth meet.
  constexpr std::array kWithin = {0.0f, 0.12f, 0.31f, 0.5f, 0.69f, 0.88f};
  constexpr int kPerTooth = kWithin.size();
  const auto [widths, heights, shorts] = crowns;
  const int count = static_cast<int>(widths.size());
  const int columns = 2 * count * kPerTooth + 1;
  // Rows from behind the chewing edge over the front of the crown to the gum, and a lip of gum
  // above.
  constexpr std::array kRows = {-0.5f, -0.15f, 0.0f, 0.1f, 0.3f, 0.55f, 0.8f, 1.0f};
  const auto first = static_cast<std::uint32_t>(mesh.position.size());
  std::vector<float> arc_at, bump_at, height_at, short_at;
  std::vector<int> tooth_at;
  for (int c = 0; c < columns; ++c) {
    const int signed_c = c - count * kPerTooth;
    const int step = std::abs(signed_c);
    const int tooth = std::min(step / kPerTooth, count - 1);
    float arc = 0;
    for (int t = 0; t < tooth; ++t) arc += widths[static_cast<std::size_t>(t)];
    const int place = step - tooth * kPerTooth;
    const float within = place < kPerTooth ? kWithin[static_cast<std::size_t>(place)] : 1.0f;
    arc += within * widths[static_cast<std::size_t>(tooth)];
    arc_at.push_back(signed_c < 0 ? -arc : arc);
    bump_at.push_back(std::sqrt(std::max(0.0f, std::sin(kPi * within))));
    height_at.push_back(heights[static_cast<std::size_t>(tooth)]);
    // Canines come to a point, the others are round at their corners.
    const float off_middle = std::abs(2 * within - 1);
    const float corner = tooth == 2 ? 1.1f * off_middle : 0.5f * std::pow(off_middle, 4.0f);
    tooth_at.push_back(tooth);
    short_at.push_back(shorts[static_cast<std::size_t>(tooth)] + corner +
                       0.1f * (1 + Grain(tooth_at.back(), static_cast<int>(jaw.upward))));
  }
  for (const float row : kRows) {
    for (int c = 0; c < columns; ++c) {
      const auto i = static_cast<std::size_t>(c);
      const float back = std::abs(arc_at[i]);
      const float shorter = short_at[i] * SmoothStep(0.6f, 0.0f, row);
      const float up = row < -0.3f ? 0.6f * height_at[i]
                       : row < 0   ? 0.3f + short_at[i]
                                   : row * height_at[i] + shorter;
      glm::vec3 p =
          AlongArch(jaw.arch, arc_at[i], jaw.arch.edge_y + jaw.upward * (up + 0.02f * back));
      const float thin = row < -0.3f    ? 4.6f
                         : row < -0.15f ? 3.2f
                         : row < 0      ? 2.2f
                         : row == 0     ? 0.9f
                                        : 0.0f;
      const float curve =
          0.5f * std::sin(kPi * std::min(1.0f, 0.25f + std::max(row, 0.0f) * 0.75f));
      p.z += curve - thin - 0.75f * (1 - bump_at[i]);
      p.x *= 1 - 0.012f * thin;
      // Deep between the teeth and in the corners of the mouth there is little light.
      const float crevice = 0.6f + 0.4f * SmoothStep(0.0f, 0.75f, bump_at[i]);
      const glm::vec3 colour = Enamel(palette, tooth_at[i], Grain(tooth_at[i], 7), row);
      const float dark = glm::mix(jaw.upward > 0 ? 0.95f : 0.52f, 0.16f, SmoothStep(6, 32, back));
      mesh.Add(p, colour, crevice * dark * (row < -0.3f ? 0.4f : 1.0f), jaw.bone);
    }
  }
  const bool flip = jaw.upward > 0;
  mesh.Grid(Material::kTeeth, first, static_cast<int>(kRows.size()), columns, flip);

  constexpr std::array kGumRows = {0.96f, 1.1f, 1.6f};
  const auto gum = static_cast<std::uint32_t>(mesh.position.size());
  for (const float row : kGumRows) {
    for (int c = 0; c < columns; ++c) {
      const auto i = static_cast<std::size_t>(c);
      const float back = std::abs(arc_at[i]);
      const float scallop = row < 1 ? 1.1f * (1 - bump_at[i]) : 0.0f;
      glm::vec3 p =
          AlongArch(jaw.arch, arc_at[i],
                    jaw.arch.edge_y + jaw.upward * (row * height_at[i] - scallop + 0.02f * back));
      p.z += row < 1 ? 0.2f : row < 1.2f ? 0.9f : 0.0f;
      mesh.Add(p, palette.gum, glm::mix(0.6f, 0.2f, SmoothStep(6, 34, back)), jaw.bone);
    }
  }
  mesh.Grid(Material::kGum, gum, static_cast<int>(kGumRows.size()), columns, flip);
}

}  // namespace

void BuildTeeth(const MouthAnatomy& mouth, const Palette& palette, HeadMesh& mesh) {
  AddArch({mouth.UpperTeeth(), 1, Bone::kSkull}, {kUpperWidth, kUpperHeight, kUpperShort}, palette,
          mesh);
  // The lower ones stand farther back, in the shade of lip and upper row.
  Palette shaded = palette;
  // What light they get comes from between red walls.
  shaded.tooth *= glm::vec3(0.30f, 0.235f, 0.20f);
  AddArch({mouth.LowerTeeth(), -1, Bone::kJaw}, {kLowerWidth, kLowerHeight, kLowerShort}, shaded,
          mesh);
}

void BuildTongue(const MouthAnatomy& mouth, const Palette& palette, HeadMesh& mesh) {
  // A rounded back over a flat belly along the floor of the mouth; its row number is its way to the
  // tip, which lies low behind the lower teeth.
  constexpr int kAlong = 17;
  constexpr int kAround = 20;
  const float tip_z = mouth.LineZ(0) - 12.5f;
  const float base_y = mouth.LineY(0) - 12.5f;
  const auto first = static_cast<std::uint32_t>(mesh.position.size());
  for (int i = 0; i < kAlong; ++i) {
    const float part = static_cast<float>(i) / (kAlong - 1);  // 0 = root, 1 = tip
    const float taper = std::sqrt(std::max(0.0f, 1 - std::pow(part, 2.2f)));
    const float half_width = 17 * taper * (0.86f + 0.14f * part) + 0.2f;
    const float height = 7.0f * taper * (1 - 0.35f * part * part) + 0.1f;
    const float z = glm::mix(tip_z - 46, tip_z, std::sin(part * kPi / 2));
    const float rise = 5.0f * (1 - part) + 3.0f * std::sin(kPi * part);
    for (int k = 0; k <= kAround; ++k) {
      const float around = 2 * kPi * static_cast<float>(k) / kAround;
      const float up = std::sin(around);
      const float groove = 1.6f * taper * std::pow(std::max(0.0f, up), 12.0f);
      const glm::vec3 p(half_width * std::cos(around), base_y + rise + height * up - groove, z);
      // The sides lie in the shade of the teeth beside them, the root in that of the palate.
      const float lit = SmoothStep(-0.2f, 1.0f, part) * SmoothStep(0, 1, up) *
                        SmoothStep(0.8f, 0.2f, std::abs(std::cos(around)));
      SkinWeights flesh;
      flesh.free = part;  // the tip bends, the root stays
      // Its outline is lost in the dark of the mouth.
      const glm::vec3 colour = glm::mix(palette.mouth, palette.tongue, SmoothStep(0, 0.5f, lit));
      mesh.Add(p, colour, 0.2f + 0.46f * lit, Bone::kTongue, flesh);
    }
  }
  mesh.Grid(Material::kTongue, first, kAlong, kAround + 1, true);
}

void FindIncisors(std::span<const glm::vec3> rest, std::span<const Bone> bone,
                  HeadTopology& topology) {
  constexpr float kMiddle = 3;  // millimetres to either side
  MouthSlit& mouth = topology.mouth;
  std::array<float, 3> best = {1e9f, 1e9f, 1e9f};
  const auto keep = [&best](std::size_t which, float y, std::uint32_t i, std::uint32_t& found) {
    if (y >= best[which]) return;
    best[which] = y;
    found = i;
  };
  for (const auto& part : topology.parts) {
    if (part.material != Material::kTeeth) continue;
    for (std::uint32_t k = part.first_index; k < part.first_index + part.index_count; ++k) {
      const std::uint32_t i = topology.indices[k];
      const glm::vec3 p = rest[i];
      if (std::abs(p.x) > kMiddle) continue;
      if (bone[i] == Bone::kJaw) {
        keep(1, -p.y, i, mouth.lower_incisor);
      } else {
        keep(0, p.y, i, mouth.upper_incisor);
        keep(2, -p.y, i, mouth.upper_root);
      }
    }
  }
}

}  // namespace fsm
