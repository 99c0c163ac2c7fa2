#pragma once

#include <functional>
#include <initializer_list>
#include <limits>
#include <vector>

namespace facefit {

// Least squares with Eigen, which stays out of this header. Pure; thread: any.

/// Linear equations row . x = value, solved for the least sum of squared residuals. REQUIRES: all
/// rows have one length, that of x.
class LinearLeastSquares {
 public:
  void Add(std::initializer_list<double> row, double value);
  /// Returns x. `ridge` (> 0) is added to the diagonal of the normal equations; it keeps unknowns
  /// near 0 that no equation determines. REQUIRES: at least one equation.
  std::vector<double> Solve(double ridge) const;

 private:
  std::vector<double> rows_, values_;
};

/// One unknown of a non-linear problem.
struct Unknown {
  double start;  ///< clamped to the bounds
  double step;   ///< for numerical derivatives
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
};
/// Returns the residuals for values of the unknowns. REQUIRES: always the same count.
using Residuals = std::function<std::vector<double>(const std::vector<double>&)>;

/// Minimises the sum of squared residuals by the method of Levenberg and Marquardt (Marquardt, An
/// Algorithm for Least-Squares Estimation of Nonlinear Parameters, 1963): a step that does not
/// lessen the sum is tried again with more damping. An unknown that is pushed against its bound
/// stays there while the others move. At most `rounds` steps.
std::vector<double> LevenbergMarquardt(const Residuals& residuals,
                                       const std::vector<Unknown>& unknowns, int rounds);

}  // namespace facefit
