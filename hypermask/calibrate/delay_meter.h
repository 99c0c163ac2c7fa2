#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "vm_protocol/core/result.h"

namespace hypermask {

/// Measures how long it takes from saying what the projector shall show until the camera's picture
/// of it is there, by a projected field that is switched on and off at times made by chance: what
/// the camera saw is compared with what was shown, moved by each delay of 0 to kLongest. Pure: told
/// the times by its user, ms. Thread: one. Limits: kMostSeen pictures.
class DelayMeter {
 public:
  static constexpr double kLongestMs = 1000;
  static constexpr std::size_t kMostSeen = 4096;
  /// How long the field stays as it is: between these, so that no delay looks like another.
  static constexpr double kLeastHoldMs = 90, kMostHoldMs = 310;
  /// How long one measures.
  static constexpr double kWholeMs = 6000;

  explicit DelayMeter(std::uint32_t seed = 1) : random_(seed) {}
  /// How long the field is to stay as it will be shown next.
  double NextHoldMs();
  /// From `ms` on the field was on or off.
  void Shown(double ms, bool on);
  /// At `ms` a picture was there whose mean brightness is `brightness`.
  void Seen(double ms, double brightness);
  /// The delay in ms. Errors: kUnavailable if the camera does not see the field, or saw too little.
  vm::Result<double> Delay() const;

 private:
  struct Switch {
    double ms;
    bool on;
  };
  struct Sight {
    double ms, brightness;
  };
  bool OnAt(double ms) const;
  std::uint32_t random_;
  std::vector<Switch> switches_;
  std::vector<Sight> sights_;
};

}  // namespace hypermask
