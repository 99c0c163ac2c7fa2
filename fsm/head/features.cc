#include "fsm/head/features.h"

#include <algorithm>
#include <cstddef>
#include <glm/common.hpp>
#include <utility>

#include "embedded/features.h"
#include "fsm/base/smooth_step.h"

namespace fsm {
namespace {

constexpr std::string_view kCurves[] = {"brow_middle", "brow_half_height", "brow_growth",
                                        "lid_fold_height", "hairline"};
/// Within what all numbers of a row must lie.
struct Limits {
  std::string_view name;
  float least, most;
};
constexpr float kMostHairs = 200;                     // in one row
constexpr float kLeastSize = 0.01f, kMostSize = 100;  // of what is divided by
constexpr Limits kLimits[] = {
    {"upper_lashes count", 1, kMostHairs},
    {"lower_lashes count", 1, kMostHairs},
    {"brow_hairs columns", 1, kMostHairs},
    {"brow_hairs rows", 1, kMostHairs},
    {"long_locks count", 1, kMostHairs},
    {"long_flyaways count", 1, kMostHairs},
    {"long_volume", 10, 1000},
    {"upper_tooth_widths", 0.5f, kMostSize},
    {"lower_tooth_widths", 0.5f, kMostSize},
    {"long_parting_soft", kLeastSize, kMostSize},
    {"long_goes_on", kLeastSize, kMostSize},
    {"stubble_place lips_half_size", kLeastSize, kMostSize},
    {"photo_lid_furrow width", kLeastSize, kMostSize},
    {"photo_lips_light", kLeastSize, kMostSize},
};

bool Ascends(const std::vector<float>& pairs) {
  for (std::size_t i = 2; i < pairs.size(); i += 2) {
    if (!(pairs[i] > pairs[i - 2])) return false;
  }
  return true;
}

}  // namespace

Features::Features(NumberTable numbers) : NumberTable(std::move(numbers)) {
  for (const TableRow& row : rows()) {
    const std::string name = NameOf(row);
    const auto& n = (*this)[name];
    if (std::ranges::find(kCurves, name) != std::end(kCurves) && !Ascends(n))
      row.Fail("numbers of x that do not ascend");
    const auto within = [&](float least, float most) {
      for (std::size_t i = row.size() - n.size(); i < row.size(); ++i) row.Within(i, least, most);
    };
    for (const Limits& limits : kLimits) {
      if (name == limits.name) within(limits.least, limits.most);
    }
    // half_size, half_width, half_height
    if (name.contains(" half_")) within(kLeastSize, kMostSize);
    if (name == "crop_crown" && Vector(name) == glm::vec3(0)) row.Fail("a crown that is nowhere");
  }
}

const Features& Features::BuiltIn() {
  static const Features features(NumberTable("tables/features.txt", embedded::features()));
  return features;
}

std::vector<glm::vec2> Features::Points(std::string_view name) const {
  const auto& n = (*this)[name];
  std::vector<glm::vec2> points;
  for (std::size_t i = 0; i + 1 < n.size(); i += 2) points.emplace_back(n[i], n[i + 1]);
  return points;
}

Curve Features::CurveOf(std::string_view name) const {
  std::vector<float> x, y;
  for (const glm::vec2 point : Points(name)) {
    x.push_back(point.x);
    y.push_back(point.y);
  }
  return {std::move(x), std::move(y)};
}

float Features::Between(std::string_view name, float part) const {
  const glm::vec2 range = Pair(name);
  return glm::mix(range.x, range.y, part);
}

float Features::Step(std::string_view name, float x) const {
  const glm::vec2 range = Pair(name);
  return SmoothStep(range.x, range.y, x);
}

}  // namespace fsm
