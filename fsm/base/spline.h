#pragma once

#include <span>
#include <vector>

namespace fsm {

/// The weights of a natural cubic spline over fixed knots: value(t) = sum of weight[i] * sample[i].
/// They do not depend on the samples, so one basis serves every row of a cage.
class SplineBasis {
 public:
  /// REQUIRES: at least two knots, strictly ascending.
  explicit SplineBasis(std::vector<float> knots);
  /// Fills `weights`, one for each knot, at `t`, which is clamped to the span of the knots.
  void Weights(float t, std::span<float> weights) const;
  const std::vector<float>& knots() const { return knots_; }

 private:
  std::vector<float> knots_;
  /// Row-major n x n: second derivative at knot i per unit of sample j.
  std::vector<float> second_;
};

/// A named curve of the face: the natural cubic spline y(x) through given points.
class Curve {
 public:
  Curve() : Curve({0, 1}, {0, 0}) {}
  /// REQUIRES: x is strictly ascending; y has its size. Outside the span the end value holds.
  Curve(std::vector<float> x, std::vector<float> y);
  float operator()(float x) const;
  float begin_x() const { return basis_.knots().front(); }
  float end_x() const { return basis_.knots().back(); }

 private:
  SplineBasis basis_;
  std::vector<float> y_;
};

}  // namespace fsm
