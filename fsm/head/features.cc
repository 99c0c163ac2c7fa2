#include "fsm/head/features.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "embedded/features.h"

namespace fsm {
namespace {

constexpr std::string_view kCurves[] = {"brow_middle", "brow_half_height", "brow_growth",
                                        "lid_fold_height", "hairline"};
/// Limits for all numbers of a row.
struct Limits {
  std::string_view name;
  float least, most;
};
constexpr float kMostHairs = 200;                     // in one row
constexpr float kLeastSize = 0.01f, kMostSize = 100;  // limits of divisors
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

Features::Features(NumberTable numbers) : FeatureNumbers(numbers), table_(std::move(numbers)) {
  for (const TableRow& row : table_.rows()) {
    const std::string name = NumberTable::RowName(row);
    const auto& n = table_[name];
    if (std::ranges::find(kCurves, name) != std::end(kCurves) && !Ascends(n))
      row.Fail("numbers of x that do not ascend");
    const auto within = [&](float least, float most) {
      for (std::size_t i = row.size() - n.size(); i < row.size(); ++i) row.Within(i, least, most);
    };
    for (const Limits& limits : kLimits) {
      if (name == limits.name) within(limits.least, limits.most);
    }
    // These are names with half_size, half_width and half_height.
    if (name.contains(" half_")) within(kLeastSize, kMostSize);
    if (name == "crop_crown" && crop_crown == glm::vec3(0)) row.Fail("a crown that is nowhere");
  }
}

const Features& Features::BuiltIn() {
  static const Features features(NumberTable("tables/features.txt", embedded::features()));
  return features;
}

std::vector<glm::vec2> PairsOf(std::span<const float> row) {
  std::vector<glm::vec2> points;
  for (std::size_t i = 0; i + 1 < row.size(); i += 2) points.emplace_back(row[i], row[i + 1]);
  return points;
}

Curve CurveOf(std::span<const float> row) {
  std::vector<float> x, y;
  for (const glm::vec2 point : PairsOf(row)) {
    x.push_back(point.x);
    y.push_back(point.y);
  }
  return {std::move(x), std::move(y)};
}

}  // namespace fsm
