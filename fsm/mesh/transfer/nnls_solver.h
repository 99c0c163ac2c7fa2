#pragma once

#include <span>
#include <vector>

namespace fsm {

/// Tells of which key shapes something is mixed: the least squares with no negative part. What
/// they cannot explain is given back. All are rows of numbers of one length and one measure.
class NnlsSolver {
 public:
  using Row = std::vector<float>;
  NnlsSolver() = default;
  explicit NnlsSolver(std::vector<Row> keys);

  struct Parts {
    std::vector<float> weights;  ///< of each key, 0..1.5
    Row residual;                ///< what they leave
  };
  Parts Solve(std::span<const float> row) const;

 private:
  std::vector<Row> keys_;
  std::vector<Row> products_;  // of each two keys
};

}  // namespace fsm
