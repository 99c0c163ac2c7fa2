#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <numbers>
#include <span>
#include <vector>

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

void AddArch(const Jaw& jaw, std::span<const float> widths, std::span<const float> heights,
             const Palette& palette, HeadMesh& mesh) {
  constexpr int kPerTooth = 3;
  const int count = static_cast<int>(widths.size());
  const int columns = 2 * count * kPerTooth + 1;
  // Rows from behind the chewing edge over the front of the crown to the gum, and a lip of gum
  // above.
  constexpr std::array kRows = {-0.5f, -0.1f, 0.0f, 0.3f, 0.7f, 1.0f};
  const auto first = static_cast<std::uint32_t>(mesh.position.size());
  std::vector<float> arc_at, bump_at, height_at;
  for (int c = 0; c < columns; ++c) {
    const int signed_c = c - count * kPerTooth;
    const int step = std::abs(signed_c);
    const int tooth = std::min(step / kPerTooth, count - 1);
    float arc = 0;
    for (int t = 0; t < tooth; ++t) arc += widths[static_cast<std::size_t>(t)];
    const float within = static_cast<float>(step - tooth * kPerTooth) / kPerTooth;
    arc += within * widths[static_cast<std::size_t>(tooth)];
    arc_at.push_back(signed_c < 0 ? -arc : arc);
    bump_at.push_back(std::sqrt(std::max(0.0f, std::sin(kPi * within))));
    height_at.push_back(heights[static_cast<std::size_t>(tooth)]);
  }
  for (const float row : kRows) {
    for (int c = 0; c < columns; ++c) {
      const auto i = static_cast<std::size_t>(c);
      const float back = std::abs(arc_at[i]);
      const float short_edge = 0.7f * (1 - bump_at[i]) + (row <= 0.12f ? 0.012f * back : 0.0f);
      const float up = row < -0.3f ? 0.6f * height_at[i]
                       : row < 0   ? 0.2f
                                   : row * height_at[i] + (row < 0.5f ? short_edge : 0.0f);
      glm::vec3 p =
          AlongArch(jaw.arch, arc_at[i], jaw.arch.edge_y + jaw.upward * (up + 0.02f * back));
      const float thin = row < -0.3f ? 4.6f : row < 0 ? 2.4f : row == 0 ? 0.9f : 0.0f;
      const float curve =
          0.9f * std::sin(kPi * std::min(1.0f, 0.25f + std::max(row, 0.0f) * 0.75f));
      p.z += curve - thin - 0.75f * (1 - bump_at[i]);
      p.x *= 1 - 0.012f * thin;
      const float crevice = 0.58f + 0.42f * std::sqrt(bump_at[i]);
      const glm::vec3 colour =
          palette.tooth * (row > 0.7f ? glm::vec3(0.95f, 0.88f, 0.78f) : glm::vec3(1));
      const float dark = glm::mix(0.95f, 0.28f, SmoothStep(8, 34, back));
      mesh.Add(p, colour, crevice * dark * (row < 0 ? 0.4f : 1.0f), jaw.bone);
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
  AddArch({mouth.UpperTeeth(), 1, Bone::kSkull}, kUpperWidth, kUpperHeight, palette, mesh);
  AddArch({mouth.LowerTeeth(), -1, Bone::kJaw}, kLowerWidth, kLowerHeight, palette, mesh);
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
    const float half_width = 17 * taper * (0.8f + 0.2f * part) + 0.2f;
    const float height = 7.0f * taper * (1 - 0.35f * part * part) + 0.1f;
    const float z = glm::mix(tip_z - 46, tip_z, std::sin(part * kPi / 2));
    const float rise = 4.0f * (1 - part);
    for (int k = 0; k <= kAround; ++k) {
      const float around = 2 * kPi * static_cast<float>(k) / kAround;
      const float up = std::sin(around);
      const float groove = 1.6f * taper * std::pow(std::max(0.0f, up), 12.0f);
      const glm::vec3 p(half_width * std::cos(around), base_y + rise + height * up - groove, z);
      // Light comes in over the tip: the back of the tongue is lost in the dark, and so are the
      // sides and all that looks down.
      const float lit =
          SmoothStep(0.28f, 0.95f, part) * glm::mix(SmoothStep(-0.3f, 0.8f, up), 1.0f, part * part);
      Flesh flesh;
      flesh.free = part;  // the tip bends, the root stays
      mesh.Add(p, palette.tongue, 0.10f + 0.7f * lit, Bone::kTongue, flesh);
    }
  }
  mesh.Grid(Material::kTongue, first, kAlong, kAround + 1, true);
}

}  // namespace fsm
