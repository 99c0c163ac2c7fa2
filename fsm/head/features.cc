#include "fsm/head/features.h"

#include <algorithm>
#include <utility>

#include "embedded/features.h"

namespace fsm {
namespace {

constexpr std::string_view kCurves[] = {"brow_middle", "brow_half_height", "brow_growth",
                                        "lid_fold_height", "hairline"};
// How many things are made.
constexpr std::string_view kCounts[] = {"upper_lashes", "lower_lashes", "brow_hairs",
                                        "long_locks",   "long_wisps",   "long_flyaways"};
constexpr float kMostHairs = 200;  // in one row

bool Ascends(const std::vector<float>& pairs) {
  for (std::size_t i = 2; i < pairs.size(); i += 2) {
    if (!(pairs[i] > pairs[i - 2])) return false;
  }
  return true;
}

}  // namespace

Features::Features(NumberTable numbers) : NumberTable(std::move(numbers)) {
  for (const TableRow& row : rows()) {
    const auto& n = (*this)[NameOf(row)];
    const auto is = [&row](std::string_view name) { return row.key() == name; };
    if (std::ranges::any_of(kCurves, is) && !Ascends(n))
      row.Fail("numbers of x that do not ascend");
    if (std::ranges::any_of(kCounts, is)) row.Within(1, 1, kMostHairs);
    if (is("brow_hairs")) row.Within(2, 1, kMostHairs);
    if (is("long_locks") && !(n[1] < n[0])) row.Fail("no lock that is not at the edge");
    if (is("long_volume")) {
      for (std::size_t i = 1; i <= 3; ++i) row.Within(i, 10, 1000);
    }
    if (is("crop_crown") && n[0] == 0 && n[1] == 0 && n[2] == 0)
      row.Fail("a crown that is nowhere");
    const bool of_tooth = row.key().ends_with("_tooth_widths");
    if (of_tooth && std::ranges::any_of(n, [](float width) { return !(width > 0.5f); }))
      row.Fail("a tooth of less than half a millimetre");
    // Half widths are divided by.
    constexpr float kLeast = 0.01f, kMost = 100;
    if (row.key().ends_with("_ridge")) row.Within(1, kLeast, kMost);
    if (is("ear_bowl") || is("ear_upper_bowl") || is("ear_tragus") || is("ear_notch")) {
      row.Within(3, kLeast, kMost);
      row.Within(4, kLeast, kMost);
    }
    if (is("long_parting_soft")) row.Within(1, kLeast, kMost);
    if (is("long_over_ear")) {
      row.Within(3, kLeast, kMost);
      row.Within(5, kLeast, kMost);
    }
    if (is("stubble_place")) {
      row.Within(5, kLeast, kMost);
      row.Within(6, kLeast, kMost);
    }
    if (is("photo_lid_furrow")) row.Within(3, kLeast, kMost);
    if (is("spot") || is("beard_thin_cheek")) {
      row.Within(4, kLeast, kMost);
      row.Within(5, kLeast, kMost);
    }
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

}  // namespace fsm
