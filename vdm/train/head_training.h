#pragma once

#include <functional>
#include <vector>

#include "vdm/train/head_lesson.h"

namespace vdm {

struct HeadPlan {
  std::size_t width = 24;  ///< units of the hidden layer
  std::size_t sounds = 0;  ///< HeadNet::sounds
  std::size_t epochs = 60;
  std::uint64_t seed = 1;
  double rate = 4e-3;
  /// By how many ms the network is to be late: so much more of a syllable is heard before the head
  /// must move with it.
  double late_ms = 0;
};

/// Learns a head by least squares, as the papers' was: from the instants within phrases. What of
/// the mean of each phrase the network does not explain becomes HeadNet::pose, and its outputs are
/// made as large as the truth within phrases is, since a network that is not sure says something
/// nearer to the mean. The same lessons give the same network on the same machine.
/// `progress`: the epoch, from 1, and the mean square of the error in units of the scales.
/// REQUIRES: a lesson with an instant in a phrase.
HeadNet LearnHead(const HeadPlan& plan, const std::vector<HeadLesson>& lessons,
                  const std::function<void(std::size_t, double)>& progress);

}  // namespace vdm
