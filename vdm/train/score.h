#pragma once

#include <string>
#include <vector>

#include "vm_protocol/core/phonemes.h"

namespace vdm {

/// How near one opening of the lips over time comes to another, and whether closures are seen.
class Score {
 public:
  /// What is shut, in mm.
  static constexpr double kShutMm = 1.0;
  /// `ours` and `truth`: the openings in mm at instants `step_ms` apart; `phonemes` begin at the
  /// first. REQUIRES: as many instants in both.
  void Add(const std::vector<double>& ours, const std::vector<double>& truth, double step_ms,
           const vm::PhonemeList& phonemes);

  std::size_t instants() const { return n_; }
  double correlation() const;  ///< of Pearson, over all instants
  double rms_mm() const;
  double size() const;  ///< how far ours moves beside the truth: the ratio of the deviations
  /// Of the p, b and m in which the true mouth is shut: the share in which ours is too, at some
  /// instant up to 20 ms before or after the sound.
  double closures_seen() const { return Share(seen_, closures_); }
  std::size_t closures() const { return closures_; }
  /// Of the instants at which the true mouth is open by 3 mm or more, and has been and will be for
  /// 30 ms: the share at which ours is shut.
  double shut_by_mistake() const { return Share(wrongly_shut_, open_); }

 private:
  static double Share(std::size_t part, std::size_t all) {
    return all == 0 ? 0 : static_cast<double>(part) / static_cast<double>(all);
  }
  std::size_t n_ = 0, closures_ = 0, seen_ = 0, open_ = 0, wrongly_shut_ = 0;
  double x_ = 0, y_ = 0, xx_ = 0, yy_ = 0, xy_ = 0;
};

}  // namespace vdm
