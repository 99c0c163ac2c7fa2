#include "fsm/base/spline.h"

#include <algorithm>
#include <cassert>

namespace fsm {

SplineBasis::SplineBasis(std::vector<float> knots) : knots_(std::move(knots)) {
  const std::size_t n = knots_.size();
  assert(n >= 2 && std::ranges::is_sorted(knots_));
  second_.assign(n * n, 0.0f);
  // Solves the tridiagonal system of the natural spline once per unit sample (Thomas algorithm).
  std::vector<float> ratio(n, 0.0f);
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const float h0 = knots_[i] - knots_[i - 1];
    const float h1 = knots_[i + 1] - knots_[i];
    const float pivot = 2 * (h0 + h1) - h0 * ratio[i - 1];
    ratio[i] = h1 / pivot;
    for (std::size_t j = 0; j < n; ++j) {
      const float slope =
          (j == i + 1 ? 6 / h1 : 0) + (j == i - 1 ? 6 / h0 : 0) - (j == i ? 6 / h0 + 6 / h1 : 0);
      second_[i * n + j] = (slope - h0 * second_[(i - 1) * n + j]) / pivot;
    }
  }
  for (std::size_t i = n - 1; i-- > 1;) {
    for (std::size_t j = 0; j < n; ++j) second_[i * n + j] -= ratio[i] * second_[(i + 1) * n + j];
  }
}

void SplineBasis::Weights(float t, std::span<float> weights) const {
  const std::size_t n = knots_.size();
  assert(weights.size() == n);
  t = std::clamp(t, knots_.front(), knots_.back());
  const auto above = std::upper_bound(knots_.begin() + 1, knots_.end() - 1, t);
  const auto i = static_cast<std::size_t>(above - knots_.begin()) - 1;
  const float h = knots_[i + 1] - knots_[i];
  const float b = (t - knots_[i]) / h;
  const float a = 1 - b;
  const float ka = (a * a * a - a) * h * h / 6;
  const float kb = (b * b * b - b) * h * h / 6;
  for (std::size_t j = 0; j < n; ++j) {
    weights[j] = ka * second_[i * n + j] + kb * second_[(i + 1) * n + j];
  }
  weights[i] += a;
  weights[i + 1] += b;
}

Curve::Curve(std::vector<float> x, std::vector<float> y) : basis_(std::move(x)), y_(std::move(y)) {
  assert(y_.size() == basis_.knots().size());
}

float Curve::operator()(float x) const {
  std::vector<float> weights(y_.size());
  basis_.Weights(x, weights);
  float sum = 0;
  for (std::size_t i = 0; i < y_.size(); ++i) sum += weights[i] * y_[i];
  return sum;
}

}  // namespace fsm
