#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "vdm/prosody/head_net.h"
#include "vdm/train/head_lesson.h"

namespace vdm {

/// The head of a whole sound each 10 ms, as a running vdm moves it.
std::vector<HeadPose> HeadOf(const HeadNet& net, const std::vector<std::int16_t>& samples,
                             float emotion);

/// The instants, in ms, at which a head nods: where it is lowest between two places that are both
/// higher by kBeatDegrees. `poses` are 10 ms apart.
std::vector<double> BeatsOf(const std::vector<HeadPose>& poses);

/// How near a head that hears comes to one that is told the text.
class HeadScore {
 public:
  static constexpr float kBeatDegrees = 0.5F;
  static constexpr double kNearMs = 80;

  /// Both 10 ms apart, from the same instant on.
  void Add(const std::vector<HeadPose>& ours, const std::vector<HeadPose>& truth);

  /// Of Pearson, of movements within a second: of how far the head is down (0), right (1), tilted
  /// (2), and of the brow (3), where ours is so many ms later.
  double correlation(std::size_t output, int late_ms) const;
  /// Of the true beats the share that has one of ours within kNearMs; of ours the share that has a
  /// true one; and what the first would be if ours came at any time (all shifted by 1 to 3 s).
  double found() const { return Share(found_, true_beats_); }
  double right() const { return Share(right_, our_beats_); }
  double by_chance() const { return Share(by_chance_, chances_); }
  std::size_t true_beats() const { return true_beats_; }
  std::size_t our_beats() const { return our_beats_; }
  /// By how many ms ours is late, in the mean over those found.
  double late_ms() const { return found_ == 0 ? 0 : late_ms_ / static_cast<double>(found_); }
  /// From the 2.5th to the 97.5th percentile, in degrees (brow: strength).
  double range(std::size_t output, bool of_truth) const;
  /// The root of the mean square of the speed, degrees a second.
  double speed(std::size_t output, bool of_truth) const;

 private:
  static double Share(std::size_t part, std::size_t all) {
    return all == 0 ? 0 : static_cast<double>(part) / static_cast<double>(all);
  }
  using Course = std::vector<float>;
  std::vector<std::array<Course, HeadNet::kOutputs>> ours_, truth_;
  std::size_t true_beats_ = 0, our_beats_ = 0, found_ = 0, right_ = 0, by_chance_ = 0, chances_ = 0;
  double late_ms_ = 0;
};

}  // namespace vdm
