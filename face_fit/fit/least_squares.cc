#include "face_fit/fit/least_squares.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cassert>

namespace facefit {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

Eigen::Map<const VectorXd> View(const std::vector<double>& v) {
  return {v.data(), static_cast<Eigen::Index>(v.size())};
}

/// The Jacobian: column i is the derivative by unknown i.
MatrixXd Derivatives(const Residuals& residuals, const std::vector<double>& at,
                     const VectorXd& here, const std::vector<Unknown>& unknowns) {
  MatrixXd slopes(here.size(), static_cast<Eigen::Index>(at.size()));
  for (std::size_t i = 0; i < at.size(); ++i) {
    auto moved = at;
    // At a bound the difference is taken inward: beyond it residuals may not change.
    const double step =
        at[i] + unknowns[i].step > unknowns[i].high ? -unknowns[i].step : unknowns[i].step;
    moved[i] += step;
    slopes.col(static_cast<Eigen::Index>(i)) = (View(residuals(moved)) - here) / step;
  }
  return slopes;
}

}  // namespace

void LinearLeastSquares::Add(std::initializer_list<double> row, double value) {
  assert(rows_.size() == values_.size() * row.size());
  rows_.insert(rows_.end(), row);
  values_.push_back(value);
}

std::vector<double> LinearLeastSquares::Solve(double ridge) const {
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
  constexpr double kFirstDamp = 1e-3, kMinDamp = 1e-9, kMaxDamp = 1e6, kDampStep = 10;
  constexpr double kRidge = 1e-9, kEnough = 1e-7;
  std::vector<double> at;
  for (const Unknown& u : unknowns) at.push_back(std::clamp(u.start, u.low, u.high));
  double damp = kFirstDamp;
  VectorXd here = View(residuals(at));
  for (int round = 0; round < rounds; ++round) {
    MatrixXd slopes = Derivatives(residuals, at, here, unknowns);
    VectorXd down = -slopes.transpose() * here;
    for (std::size_t i = 0; i < at.size(); ++i) {
      const auto k = static_cast<Eigen::Index>(i);
      const bool held = down[k] < 0 ? at[i] <= unknowns[i].low : at[i] >= unknowns[i].high;
      if (!held) continue;
      slopes.col(k).setZero();
      down[k] = 0;
    }
    const MatrixXd normal = slopes.transpose() * slopes;
    const double before = here.squaredNorm();
    bool smaller = false;
    while (!smaller) {
      if (damp > kMaxDamp) return at;  // no step in any direction helps
      MatrixXd damped = normal;
      damped.diagonal() += damp * normal.diagonal() + VectorXd::Constant(down.size(), kRidge);
      const VectorXd by = damped.ldlt().solve(down);
      auto next = at;
      for (std::size_t i = 0; i < at.size(); ++i) {
        next[i] =
            std::clamp(at[i] + by[static_cast<Eigen::Index>(i)], unknowns[i].low, unknowns[i].high);
      }
      const VectorXd there = View(residuals(next));
      smaller = there.squaredNorm() < before;
      damp *= smaller ? 1 / kDampStep : kDampStep;
      if (!smaller) continue;
      at = std::move(next);
      here = there;
    }
    damp = std::max(damp, kMinDamp);
    if (before - here.squaredNorm() < kEnough * before) break;
  }
  return at;
}

}  // namespace facefit
