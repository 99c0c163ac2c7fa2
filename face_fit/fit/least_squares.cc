#include "face_fit/fit/least_squares.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cassert>
#include <optional>
#include <utility>

namespace facefit {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

Eigen::Map<const VectorXd> View(const std::vector<double>& v) {
  return {v.data(), static_cast<Eigen::Index>(v.size())};
}

/// Values of the unknowns, and the residuals there.
struct Trial {
  std::vector<double> x;
  VectorXd residual;
};

/// Column i is the derivative of the residuals by unknown i.
MatrixXd Jacobian(const Residuals& residuals, const std::vector<Unknown>& unknowns,
                  const Trial& at) {
  MatrixXd jacobian(at.residual.size(), static_cast<Eigen::Index>(at.x.size()));
  for (std::size_t i = 0; i < at.x.size(); ++i) {
    auto moved = at.x;
    // At a bound the difference is taken inward: beyond it residuals may not change.
    const double delta =
        at.x[i] + unknowns[i].step > unknowns[i].high ? -unknowns[i].step : unknowns[i].step;
    moved[i] += delta;
    jacobian.col(static_cast<Eigen::Index>(i)) = (View(residuals(moved)) - at.residual) / delta;
  }
  return jacobian;
}

/// Takes the damped step within the bounds. `normal`: Jacobian transposed times Jacobian;
/// `descent`: negative gradient. Returns nothing if the step does not lessen the sum of squares.
std::optional<Trial> TryStep(const Residuals& residuals, const std::vector<Unknown>& unknowns,
                             const Trial& from, const MatrixXd& normal, const VectorXd& descent,
                             double damping) {
  constexpr double kRidge = 1e-9;
  MatrixXd damped = normal;
  damped.diagonal() += damping * normal.diagonal() + VectorXd::Constant(descent.size(), kRidge);
  const VectorXd step = damped.ldlt().solve(descent);
  Trial next = from;
  for (std::size_t i = 0; i < next.x.size(); ++i) {
    next.x[i] = std::clamp(from.x[i] + step[static_cast<Eigen::Index>(i)], unknowns[i].low,
                           unknowns[i].high);
  }
  next.residual = View(residuals(next.x));
  if (!(next.residual.squaredNorm() < from.residual.squaredNorm())) return std::nullopt;
  return next;
}

}  // namespace

void LinearLeastSquares::Add(std::initializer_list<double> row, double value) {
  assert(rows_.size() == values_.size() * row.size());
  rows_.insert(rows_.end(), row);
  values_.push_back(value);
}

std::vector<double> LinearLeastSquares::Solve(double ridge) const {
  assert(!values_.empty());
  const auto unknowns = static_cast<Eigen::Index>(rows_.size() / values_.size());
  const Eigen::Map<const MatrixXd> columns(rows_.data(), unknowns,
                                           static_cast<Eigen::Index>(values_.size()));
  MatrixXd normal = columns * columns.transpose();
  normal.diagonal().array() += ridge;
  const VectorXd solved = normal.ldlt().solve(columns * View(values_));
  return {solved.begin(), solved.end()};
}

std::vector<double> LevenbergMarquardt(const Residuals& residuals,
                                       const std::vector<Unknown>& unknowns, int rounds) {
  constexpr double kFirstDamping = 1e-3, kMinDamping = 1e-9, kMaxDamping = 1e6;
  constexpr double kDampingFactor = 10, kEnough = 1e-7;
  Trial current;
  for (const Unknown& u : unknowns) current.x.push_back(std::clamp(u.start, u.low, u.high));
  current.residual = View(residuals(current.x));
  double damping = kFirstDamping;
  for (int round = 0; round < rounds; ++round) {
    MatrixXd jacobian = Jacobian(residuals, unknowns, current);
    VectorXd descent = -jacobian.transpose() * current.residual;
    for (std::size_t i = 0; i < unknowns.size(); ++i) {
      const auto k = static_cast<Eigen::Index>(i);
      const bool held =
          descent[k] < 0 ? current.x[i] <= unknowns[i].low : current.x[i] >= unknowns[i].high;
      if (!held) continue;
      jacobian.col(k).setZero();
      descent[k] = 0;
    }
    const MatrixXd normal = jacobian.transpose() * jacobian;
    std::optional<Trial> next;
    while (!(next = TryStep(residuals, unknowns, current, normal, descent, damping))) {
      damping *= kDampingFactor;
      if (damping > kMaxDamping) return current.x;  // no step in any direction helps
    }
    damping = std::max(damping * (1 / kDampingFactor), kMinDamping);
    const double before = current.residual.squaredNorm();
    current = std::move(*next);
    if (before - current.residual.squaredNorm() < kEnough * before) break;
  }
  return current.x;
}

}  // namespace facefit
