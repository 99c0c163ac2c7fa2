#include "face_track/model/lips.h"

#include <fmt/format.h>

#include <algorithm>
#include <glm/geometric.hpp>
#include <span>

#include "embedded/mouth_of_lips.h"
#include "fsm/base/table_reader.h"
#include "vm_protocol/core/or_throw.h"

namespace facetrack {
namespace {

constexpr float kMouthWidth = 50;     // mm of the mouth that mouth parameters are told of
constexpr float kFull = 40.0F / 30;   // full articulation beside the usual (slot MouthScale)
constexpr float kMmPerDegree = 1.4F;  // by which the jaw lowers the lower lip
constexpr std::size_t kCornerR = 61, kCornerL = 291;

// Points of MediaPipe's mesh. Those of both sides are together, so that a list has one height.
constexpr std::size_t kUpperInners[] = {13, 82, 312}, kUpperInnerSides[] = {80, 81, 310, 311},
                      kUpperOuters[] = {0, 37, 267}, kUpperOuterSides[] = {39, 40, 269, 270},
                      kLowerInners[] = {14, 87, 317}, kLowerInnerSides[] = {88, 178, 318, 402},
                      kLowerOuters[] = {17, 84, 314}, kLowerOuterSides[] = {91, 181, 321, 405},
                      kCorners[] = {kCornerR, kCornerL}, kInnerCorners[] = {78, 308},
                      kChin[] = {148, 152, 175, 199, 377};

constexpr std::string_view kParameterNames[] = {"upper_outer_y",
                                                "upper_outer_z",
                                                "upper_inner_y",
                                                "upper_inner_z",
                                                "lower_inner_y",
                                                "lower_inner_z",
                                                "lower_outer_y",
                                                "lower_outer_z",
                                                "corner_x",
                                                "corner_y",
                                                "corner_z",
                                                "jaw_y",
                                                "jaw_z",
                                                "upper_outer_fullness",
                                                "upper_inner_fullness",
                                                "lower_outer_fullness",
                                                "lower_inner_fullness"};
static_assert(std::size(kParameterNames) == fsm::kMouthParameters);

MouthOfLips ReadMouth(const fsm::Table& table) {
  MouthOfLips mouth;
  const fsm::TableRow& seal = table.Only("seal");
  mouth.closed_mm = seal.Number(1);
  mouth.open_mm = seal.Number(2);
  if (!(mouth.open_mm > mouth.closed_mm)) seal.Refuse("expected a closed gap below the open one");
  for (std::size_t p = 0; p < fsm::kMouthParameters; ++p) {
    const fsm::TableRow& row = table.Only(std::string(kParameterNames[p]));
    const auto numbers = row.Numbers(1);
    if (numbers.size() != kLips) row.Refuse(fmt::format("expected {} numbers", kLips));
    std::ranges::copy(numbers, mouth.factors[p].begin());
  }
  return mouth;
}

}  // namespace

Lips LipsOf(const Points& points, const Points& rest) {
  const float scale = kMouthWidth / std::max(glm::distance(rest[kCornerR], rest[kCornerL]), 1.0F);
  const auto mean = [&](std::span<const std::size_t> list, auto number) {
    float sum = 0;
    for (const std::size_t i : list) sum += number(points[i] - rest[i], rest[i]);
    return scale * sum / static_cast<float>(list.size());
  };
  const auto up = [&](std::span<const std::size_t> list) {
    return mean(list, [](glm::vec3 by, glm::vec3) { return by.y; });
  };
  const auto out = [&](std::span<const std::size_t> list) {
    return mean(list, [](glm::vec3 by, glm::vec3 from) { return from.x > 0 ? by.x : -by.x; });
  };
  const float gap = std::max(up(kUpperInners) - up(kLowerInners), 0.0F);
  return {up(kUpperInners), up(kUpperInnerSides), up(kUpperOuters),   up(kUpperOuterSides),
          up(kLowerInners), up(kLowerInnerSides), up(kLowerOuters),   up(kLowerOuterSides),
          out(kCorners),    up(kCorners),         out(kInnerCorners), up(kChin),
          gap / (gap + 2)};
}

TrackedMouth MouthOfLips::Mouth(const Lips& lips) const {
  TrackedMouth mouth;
  for (std::size_t p = 0; p < fsm::kMouthParameters; ++p) {
    for (std::size_t k = 0; k < kLips; ++k) mouth.parameters[p] += kFull * factors[p][k] * lips[k];
  }
  float& jaw = mouth.parameters[fsm::kJawY];
  jaw = std::max(jaw, 0.0F);  // it does not go up beyond its rest
  const float gap = Gap(mouth.parameters);
  mouth.seal = std::clamp((open_mm - gap) / (open_mm - closed_mm), 0.0F, 1.0F);
  return mouth;
}

float MouthOfLips::Gap(const std::array<float, fsm::kMouthParameters>& parameters) {
  return parameters[fsm::kUpperInnerY] - parameters[fsm::kLowerInnerY] +
         kMmPerDegree * parameters[fsm::kJawY];
}

vm::Result<MouthOfLips> MouthOfLips::Parse(const std::string& name, std::string_view text) {
  return fsm::ReadTable(name, text, ReadMouth);
}

std::string MouthOfLips::Print() const {
  std::string text =
      "# The mouth parameters that lips show; face_track_learn --mouth makes this file\n"
      "# (docs/tracking.md). A parameter (fsm/motion/tables/mouth_shapes.txt) is the sum of a\n"
      "# row's factors times how far the lips' parts lie from where they are at rest, in mm on a\n"
      "# mouth 50 mm wide, upward: the upper lip's inner edge in the middle and at the sides, its\n"
      "# outer edge likewise, the lower lip's inner and outer edge likewise; the corners outward\n"
      "# and up, the inner corners outward, the chin up; and gap / (gap + 2 mm) of the inner "
      "edges.\n"
      "#\n"
      "# seal CLOSED OPEN   mm by which the parameters part the lips: sealed up to the first, open "
      "from the other\n";
  text += fmt::format("seal {:.2f} {:.2f}\n", closed_mm, open_mm);
  for (std::size_t p = 0; p < fsm::kMouthParameters; ++p) {
    text += fmt::format("{:21}", kParameterNames[p]);
    for (const float factor : factors[p]) text += fmt::format(" {:6.3f}", factor);
    text += "\n";
  }
  return text;
}

const MouthOfLips& MouthOfLips::Shipped() {
  static const MouthOfLips mouth =
      vm::OrThrow(Parse("mouth_of_lips.txt", embedded::mouth_of_lips()));
  return mouth;
}

}  // namespace facetrack
