#include "face_track/fit/bounded_solve.h"

#include <limits>
#include <vector>

namespace facetrack {

Eigen::VectorXf BoundedSolve(const Eigen::MatrixXf& a, const Eigen::VectorXf& b,
                             const Eigen::VectorXf& low, const Eigen::VectorXf& high) {
  const Eigen::Index count = b.size();
  Eigen::VectorXf x = Eigen::VectorXf::Zero(count);
  std::vector<bool> held(static_cast<std::size_t>(count), false);
  const auto is_held = [&](Eigen::Index i) { return held[static_cast<std::size_t>(i)]; };
  for (Eigen::Index round = 0; round < 4 * count; ++round) {
    std::vector<Eigen::Index> free;
    Eigen::VectorXf fixed = Eigen::VectorXf::Zero(count);
    for (Eigen::Index i = 0; i < count; ++i) {
      if (is_held(i))
        fixed[i] = x[i];
      else
        free.push_back(i);
    }
    const Eigen::VectorXf wanted = b - a * fixed;
    const Eigen::VectorXf solved = a(free, free).ldlt().solve(wanted(free));
    // As far towards it as the bounds allow; who is stopped by one is held there.
    float step = 1;
    for (std::size_t k = 0; k < free.size(); ++k) {
      const Eigen::Index i = free[k];
      const float by = solved[static_cast<Eigen::Index>(k)] - x[i];
      if (x[i] + by > high[i]) step = std::min(step, (high[i] - x[i]) / by);
      if (x[i] + by < low[i]) step = std::min(step, (low[i] - x[i]) / by);
    }
    for (std::size_t k = 0; k < free.size(); ++k) {
      const Eigen::Index i = free[k];
      const float whole = solved[static_cast<Eigen::Index>(k)];
      const float by = step * (whole - x[i]);
      constexpr float kSame = 1e-6F;
      if (whole > high[i] && x[i] + by >= high[i] - kSame)
        x[i] = high[i], held[static_cast<std::size_t>(i)] = true;
      else if (whole < low[i] && x[i] + by <= low[i] + kSame)
        x[i] = low[i], held[static_cast<std::size_t>(i)] = true;
      else
        x[i] += by;
    }
    if (step < 1) continue;
    // Whoever is held and would rather come back is let go, the most eager first.
    const Eigen::VectorXf pull = b - a * x;
    Eigen::Index eager = -1;
    float most = 1e-4F;
    for (Eigen::Index i = 0; i < count; ++i) {
      if (!is_held(i) || low[i] == high[i]) continue;
      const float inward = x[i] <= low[i] ? pull[i] : -pull[i];
      if (inward > most) most = inward, eager = i;
    }
    if (eager < 0) break;
    held[static_cast<std::size_t>(eager)] = false;
  }
  return x;
}

}  // namespace facetrack
