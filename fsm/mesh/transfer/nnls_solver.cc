#include "fsm/mesh/transfer/nnls_solver.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace fsm {
namespace {

float Product(const NnlsSolver::Row& a, const NnlsSolver::Row& b) {
  float sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

}  // namespace

NnlsSolver::NnlsSolver(std::vector<Row> keys) : keys_(std::move(keys)) {
  for (const Row& a : keys_) {
    Row products;
    for (const Row& b : keys_) products.push_back(Product(a, b));
    products_.push_back(std::move(products));
  }
}

NnlsSolver::Parts NnlsSolver::Solve(std::span<const float> row) const {
  // Coordinate descent: each weight in turn is set to its optimum. A small penalty on the weights
  // prefers few keys.
  constexpr int kRounds = 60;
  constexpr float kPrice = 0.05f, kMax = 1.5f, kMin = 1e-3f;
  Parts parts;
  parts.residual.assign(row.begin(), row.end());
  for (float& v : parts.residual) {
    if (!std::isfinite(v)) v = 0;
  }
  parts.weights.assign(keys_.size(), 0);
  std::vector<float> slope;  // negative gradient of the error, by key
  float size = 0;
  for (const Row& key : keys_) {
    slope.push_back(Product(key, parts.residual));
    size = std::max(size, std::abs(slope.back()));
  }
  if (size < kMin) return parts;
  for (int round = 0; round < kRounds; ++round) {
    float moved = 0;
    for (std::size_t k = 0; k < keys_.size(); ++k) {
      const float own = products_[k][k];
      if (own < kMin) continue;
      const float wanted = std::clamp(parts.weights[k] + (slope[k] - kPrice) / own, 0.0f, kMax);
      const float by = wanted - parts.weights[k];
      if (by == 0) continue;
      parts.weights[k] = wanted;
      moved = std::max(moved, std::abs(by));
      for (std::size_t j = 0; j < keys_.size(); ++j) slope[j] -= by * products_[k][j];
    }
    if (moved < kMin) break;
  }
  for (std::size_t k = 0; k < keys_.size(); ++k) {
    for (std::size_t i = 0; i < row.size(); ++i) {
      parts.residual[i] -= parts.weights[k] * keys_[k][i];
    }
  }
  return parts;
}

}  // namespace fsm
