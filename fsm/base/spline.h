#pragma once

#include <span>
#include <vector>

namespace fsm {

/// The natural cubic spline over fixed knots, as weights: value(t) = sum of weight[i] * sample[i].
/// Keeping the weights apart from the samples lets one basis serve every row of a cage.
class SplineBasis {
 public:
  /// REQUIRES: at least two knots, strictly ascending.
  explicit SplineBasis(std::vector<float> knots);
  /// Weights of all knots at `t`, clamped to the knots' span. `weights` has knots().size() entries.
  void Weights(float t, std::span<float> weights) const;
  const std::vector<float>& knots() const { return knots_; }

 private:
  std::vector<float> knots_;
  /// Row-major n x n: second derivative at knot i per unit of sample j.
  std::vector<float> second_;
};

/// A function y(x) through given points, for named curves of the face.
class Curve {
 public:
  Curve() : Curve({0, 1}, {0, 0}) {}
  /// REQUIRES: x strictly ascending, as many y. Outside the span the end value holds.
  Curve(std::vector<float> x, std::vector<float> y);
  float operator()(float x) const;
  float begin_x() const { return basis_.knots().front(); }
  float end_x() const { return basis_.knots().back(); }

 private:
  SplineBasis basis_;
  std::vector<float> y_;
};

}  // namespace fsm
