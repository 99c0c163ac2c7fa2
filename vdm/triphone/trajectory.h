#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <vector>

namespace vdm {

/// What is looked at of a number over time x: itself, its slope (x[t+1] - x[t-1]) / 2 and its bend
/// x[t-1] - 2 x[t] + x[t+1].
inline constexpr std::size_t kWindows = 3;

/// The windows of each row of `track` at each instant: kWindows * rows x instants, all values
/// first, then all slopes, then all bends. Beyond its ends a track stays as it is there.
Eigen::MatrixXd WindowsOf(const Eigen::MatrixXd& track);

/// What a number and its windows are expected to be, and how far they usually are from it.
struct Expectation {
  Eigen::VectorXd means;      ///< as a column of WindowsOf
  Eigen::VectorXd variances;  ///< above 0
};

/// The track whose windows fit best what is expected at each instant: maximum likelihood with
/// dynamic features (Tokuda and others, "Speech parameter generation algorithms for HMM-based
/// speech synthesis", ICASSP 2000). Each row is a system of five diagonals; the time is
/// proportional to the instants. REQUIRES: pointers that point, sizes alike.
Eigen::MatrixXd LikeliestTrack(const std::vector<const Expectation*>& expected);

}  // namespace vdm
