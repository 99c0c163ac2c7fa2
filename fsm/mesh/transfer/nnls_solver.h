#pragma once

#include <span>
#include <vector>

namespace fsm {

/// Decomposes a vector into a sum of key vectors with non-negative weights by least squares (NNLS),
/// and returns weights and residual. All vectors have the same length and unit.
class NnlsSolver {
 public:
  using Row = std::vector<float>;
  NnlsSolver() = default;
  explicit NnlsSolver(std::vector<Row> keys);

  struct Parts {
    std::vector<float> weights;  ///< one for each key, 0..1.5
    Row residual;                ///< the vector minus the weighted keys
  };
  Parts Solve(std::span<const float> row) const;

 private:
  std::vector<Row> keys_;
  std::vector<Row> products_;  // dot products of each two keys
};

}  // namespace fsm
