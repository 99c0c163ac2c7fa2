#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace facefit {

/// Sums up equations row . x = value of a few unknowns and solves them by least squares.
template <std::size_t N>
class LeastSquares {
 public:
  using Row = std::array<double, N>;
  void Add(const Row& row, double value) {
    for (std::size_t i = 0; i < N; ++i) {
      for (std::size_t j = 0; j < N; ++j) a_[i][j] += row[i] * row[j];
      b_[i] += row[i] * value;
    }
  }
  /// `hold` keeps unknowns near 0 that no equation tells anything about, `damp` all of them in
  /// proportion.
  Row Solve(double hold, double damp = 0) const {
    auto a = a_;
    Row b = b_;
    for (std::size_t i = 0; i < N; ++i) a[i][i] = a[i][i] * (1 + damp) + hold;
    // Elimination without pivots, which a symmetric positive matrix does not need.
    for (std::size_t k = 0; k < N; ++k) {
      for (std::size_t i = k + 1; i < N; ++i) {
        const double f = a[i][k] / a[k][k];
        for (std::size_t j = k; j < N; ++j) a[i][j] -= f * a[k][j];
        b[i] -= f * b[k];
      }
    }
    for (std::size_t k = N; k-- > 0;) {
      for (std::size_t j = k + 1; j < N; ++j) b[k] -= a[k][j] * b[j];
      b[k] /= a[k][k];
    }
    return b;
  }

 private:
  std::array<Row, N> a_{};
  Row b_{};
};

/// Gauss and Newton with differences for derivatives: makes the squares of `residuals(row)` small.
/// `keep(row)` brings unknowns back within their bounds.
template <std::size_t N, typename Residuals, typename Keep>
std::array<double, N> GaussNewton(const Residuals& residuals, std::array<double, N> p,
                                  const std::array<double, N>& steps, int rounds,
                                  const Keep& keep) {
  for (int round = 0; round < rounds; ++round) {
    const std::vector<double> here = residuals(p);
    std::array<std::vector<double>, N> slopes;
    for (std::size_t i = 0; i < N; ++i) {
      auto moved = p;
      moved[i] += steps[i];
      slopes[i] = residuals(moved);
    }
    LeastSquares<N> sum;
    for (std::size_t r = 0; r < here.size(); ++r) {
      std::array<double, N> row{};
      for (std::size_t i = 0; i < N; ++i) row[i] = (slopes[i][r] - here[r]) / steps[i];
      sum.Add(row, -here[r]);
    }
    const auto by = sum.Solve(1e-9, 1e-3);
    for (std::size_t i = 0; i < N; ++i) p[i] += by[i];
    keep(p);
  }
  return p;
}

}  // namespace facefit
