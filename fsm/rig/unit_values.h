#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <stdexcept>
#include <vector>

namespace fsm {

/// FACS of 1978 numbers its action units 1..46 (3 and 40 unused); a table of this size has room
/// for all of them by number.
inline constexpr std::size_t kActionUnits = 47;
/// Numbers that FACS leaves free, in which residuals of the original's expressions travel
/// (mesh/original_expressions.h): no table has them, and heads other than the original's have no
/// channel for them.
inline constexpr std::array<std::size_t, 3> kResidualUnits{3, 40, 0};
/// The units that code looks at by itself, by their names in FACS.
enum ActionUnit : std::size_t {
  kInnerBrowRaiser = 1,
  kOuterBrowRaiser = 2,
  kBrowLowerer = 4,
  kCheekRaiser = 6,
  kNoseWrinkler = 9,
  kUpperLipRaiser = 10,
  kNasolabialDeepener = 11,
  kLipCornerPuller = 12,
  kLipsPart = 25,
  kJawDrop = 26,
  kMouthStretch = 27,
  kNostrilDilator = 38,
  kLidDroop = 41,
  kEyesClosed = 43
};

/// Strengths of the action units of one side by number: 0 = rest, 1 = full. The units of FACS are
/// always there; a unit with a higher number exists from when it is first written on, and reads 0
/// before. A plain value; up to number 46 it needs no memory of its own.
/// Limits: kMost; writing beyond it throws std::out_of_range.
/// Lifetime: references and iterators are valid until a higher number is written.
class UnitValues {
 public:
  static constexpr std::size_t kMost = 999;  ///< the highest number of a unit

  float operator[](std::size_t unit) const { return unit < size() ? begin()[unit] : 0; }
  float& operator[](std::size_t unit) {
    if (unit < kActionUnits && more_.empty()) return first_[unit];
    return AtHigh(unit);
  }
  /// One above the highest number that is there.
  std::size_t size() const { return more_.empty() ? first_.size() : more_.size(); }
  const float* begin() const { return more_.empty() ? first_.data() : more_.data(); }
  const float* end() const { return begin() + size(); }
  void fill(float strength) {
    first_.fill(strength);
    std::ranges::fill(more_, strength);
  }
  bool AtRest() const {
    return std::all_of(begin(), end(), [](float strength) { return strength == 0; });
  }
  /// True if every number reads the same.
  friend bool operator==(const UnitValues& a, const UnitValues& b) {
    for (std::size_t unit = 0; unit < std::max(a.size(), b.size()); ++unit) {
      if (a[unit] != b[unit]) return false;
    }
    return true;
  }

 private:
  float& AtHigh(std::size_t unit) {
    if (unit > kMost) throw std::out_of_range("the number of an action unit is above 999");
    if (more_.empty()) more_.assign(first_.begin(), first_.end());
    if (unit >= more_.size()) more_.resize(unit + 1);
    return more_[unit];
  }

  std::array<float, kActionUnits> first_{};
  std::vector<float> more_;  // all of them, once one above FACS has been written; else empty
};

}  // namespace fsm
