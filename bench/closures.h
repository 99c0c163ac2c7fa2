#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace speech_bench {

struct Interval {
  double start = 0, end = 0;  // ms
  std::string name{};
};

inline bool IsClosure(const std::string& name) { return name == "p" || name == "b" || name == "m"; }

/// How often a mouth is closed when p, b and m need it to be.
struct Closures {
  int hit = 0, all = 0;
  double error_sum = 0;  ///< ms, of the beginning of the nearest closed mouth
  double mean_error() const { return all > 0 ? error_sum / all : 0; }

  /// A closure is hit if the mouth is closed in the middle of it. One without any closed mouth
  /// within a second counts a second.
  void Add(const std::vector<Interval>& phonemes, const std::vector<Interval>& closed) {
    for (const Interval& truth : phonemes) {
      if (!IsClosure(truth.name)) continue;
      ++all;
      const double middle = (truth.start + truth.end) / 2;
      double nearest = 1000;
      bool hit_it = false;
      for (const Interval& one : closed) {
        hit_it = hit_it || (one.start <= middle && middle < one.end);
        nearest = std::min(nearest, std::abs(one.start - truth.start));
      }
      hit += hit_it;
      error_sum += nearest;
    }
  }
};

}  // namespace speech_bench
