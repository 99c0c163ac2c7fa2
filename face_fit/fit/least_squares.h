#pragma once

#include <functional>
#include <initializer_list>
#include <limits>
#include <vector>

namespace facefit {

// Least squares. Eigen does the algebra; only least_squares.cc includes it. Pure; thread: any.

/// Equations row . x = value, to be solved so that the sum of the squares of what is missing is
/// least. REQUIRES: all rows have one length, that of x.
class LinearLeastSquares {
 public:
  void Add(std::initializer_list<double> row, double value);
  /// `ridge` (> 0) is added to the diagonal of the normal equations: it keeps unknowns near 0 that
  /// no equation tells anything about.
  std::vector<double> Solve(double ridge) const;

 private:
  std::vector<double> rows_, values_;
};

/// One unknown of a non-linear problem.
struct Unknown {
  double start;  ///< brought within the bounds
  double step;   ///< over which derivatives are taken
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
};
/// The numbers to be made small, for values of the unknowns. REQUIRES: always of one length.
using Residuals = std::function<std::vector<double>(const std::vector<double>&)>;

/// Makes the sum of the squares of the residuals small by Levenberg's and Marquardt's method
/// (Marquardt, An Algorithm for Least-Squares Estimation of Nonlinear Parameters, 1963): a step is
/// taken only if it makes the sum smaller, else it is tried again with more damping. An unknown
/// that is pushed against its bound stays there while the others move. At most `rounds` steps.
std::vector<double> LevenbergMarquardt(const Residuals& residuals,
                                       const std::vector<Unknown>& unknowns, int rounds);

}  // namespace facefit
