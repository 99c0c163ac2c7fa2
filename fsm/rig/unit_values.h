#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <stdexcept>
#include <vector>

namespace fsm {

/// The action units of FACS (1978) have numbers 1..46 (3 and 40 are unused); a table of this size
/// is indexed by them directly.
inline constexpr std::size_t kActionUnits = 47;
/// The units that code refers to, by their names in FACS.
enum ActionUnit : std::size_t {
  kInnerBrowRaiser = 1,
  kOuterBrowRaiser = 2,
  kCheekRaiser = 6,
  kLipCornerPuller = 12,
  kLipsPart = 25,
  kJawDrop = 26,
  kMouthStretch = 27,
  kNostrilDilator = 38,
  kLidDroop = 41,
  kEyesClosed = 43
};

/// The greatest strength of a unit and of an expression, the original's 200 %.
inline constexpr float kMaxStrength = 2;

/// Strengths of the action units of one side by number: 0 = rest, 1 = full. The units of FACS
/// always exist; a unit with a higher number exists once it has been written, and reads 0 before. A
/// plain value; it allocates only for numbers above 46.
/// Limits: kMax; writing beyond it throws std::out_of_range.
/// Lifetime: references and iterators are valid until a higher number is written.
class UnitValues {
 public:
  static constexpr std::size_t kMax = 999;  ///< the highest number of a unit

  float operator[](std::size_t unit) const { return unit < size() ? begin()[unit] : 0; }
  float& operator[](std::size_t unit) {
    if (unit < kActionUnits && more_.empty()) return first_[unit];
    return AtHigh(unit);
  }
  /// Returns one above the highest number that exists.
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
  /// Compares as if both had every number; missing ones are 0.
  friend bool operator==(const UnitValues& a, const UnitValues& b) {
    for (std::size_t unit = 0; unit < std::max(a.size(), b.size()); ++unit) {
      if (a[unit] != b[unit]) return false;
    }
    return true;
  }

 private:
  float& AtHigh(std::size_t unit) {
    if (unit > kMax) throw std::out_of_range("the number of an action unit is above 999");
    if (more_.empty()) more_.assign(first_.begin(), first_.end());
    if (unit >= more_.size()) more_.resize(unit + 1);
    return more_[unit];
  }

  std::array<float, kActionUnits> first_{};
  std::vector<float> more_;  // all strengths, once a number above FACS has been written; else empty
};

}  // namespace fsm
