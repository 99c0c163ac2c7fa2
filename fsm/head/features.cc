#include "fsm/head/features.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "embedded/features.h"

namespace fsm {
namespace {

constexpr std::string_view kCurves[] = {"brow_middle", "brow_half_height", "brow_growth",
                                        "lid_fold_height", "hairline"};

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
      row.Refuse("numbers of x that do not ascend");
    if (name == "crop_hair crown" && crop_hair.crown == glm::vec3(0))
      row.Refuse("a crown that is nowhere");
  }
}

const std::shared_ptr<const Features>& Features::BuiltIn() {
  static const std::shared_ptr<const Features> features(
      new Features(NumberTable("tables/features.txt", embedded::features())));
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
