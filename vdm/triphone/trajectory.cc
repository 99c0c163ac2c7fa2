#include "vdm/triphone/trajectory.h"

#include <Eigen/SparseCholesky>
#include <algorithm>

namespace vdm {
namespace {

/// By window: the weights of the instant before, of the instant, and of the one after.
constexpr std::array<std::array<double, 3>, kWindows> kWeights = {
    {{0, 1, 0}, {-0.5, 0, 0.5}, {1, -2, 1}}};

Eigen::Index Near(Eigen::Index t, int offset, Eigen::Index size) {
  return std::clamp<Eigen::Index>(t + offset, 0, size - 1);
}

}  // namespace

Eigen::MatrixXd WindowsOf(const Eigen::MatrixXd& track) {
  const Eigen::Index rows = track.rows(), size = track.cols();
  Eigen::MatrixXd windows = Eigen::MatrixXd::Zero(rows * static_cast<Eigen::Index>(kWindows), size);
  for (std::size_t w = 0; w < kWindows; ++w) {
    for (Eigen::Index t = 0; t < size; ++t) {
      for (int offset = -1; offset <= 1; ++offset) {
        windows.block(static_cast<Eigen::Index>(w) * rows, t, rows, 1) +=
            kWeights[w][static_cast<std::size_t>(offset + 1)] * track.col(Near(t, offset, size));
      }
    }
  }
  return windows;
}

Eigen::MatrixXd LikeliestTrack(const std::vector<const Expectation*>& expected) {
  const auto size = static_cast<Eigen::Index>(expected.size());
  if (size == 0) return {};
  const Eigen::Index rows = expected.front()->means.size() / static_cast<Eigen::Index>(kWindows);
  Eigen::MatrixXd track(rows, size);
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver;
  for (Eigen::Index row = 0; row < rows; ++row) {
    // Normal equations of all windows of this row, each weighed by how sure it is.
    std::vector<Eigen::Triplet<double>> matrix;
    Eigen::VectorXd right = Eigen::VectorXd::Zero(size);
    for (Eigen::Index t = 0; t < size; ++t) {
      const Expectation& here = *expected[static_cast<std::size_t>(t)];
      for (std::size_t w = 0; w < kWindows; ++w) {
        const Eigen::Index at = static_cast<Eigen::Index>(w) * rows + row;
        const double sure = 1 / here.variances[at];
        for (int i = 0; i < 3; ++i) {
          const double weight = kWeights[w][static_cast<std::size_t>(i)] * sure;
          right[Near(t, i - 1, size)] += weight * here.means[at];
          for (int j = 0; j < 3; ++j) {
            matrix.emplace_back(Near(t, i - 1, size), Near(t, j - 1, size),
                                weight * kWeights[w][static_cast<std::size_t>(j)]);
          }
        }
      }
    }
    Eigen::SparseMatrix<double> system(size, size);
    system.setFromTriplets(matrix.begin(), matrix.end());
    if (row == 0) solver.analyzePattern(system);
    solver.factorize(system);
    track.row(row) = solver.solve(right).transpose();
  }
  return track;
}

}  // namespace vdm
