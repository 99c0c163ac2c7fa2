#pragma once

#include <Eigen/Dense>

namespace facetrack {

/// The x between `low` and `high` (0 lies between them) that makes x' A x / 2 - b' x least, A
/// symmetric and positive definite: least squares with bounds, by sets of unknowns that are held at
/// a bound (Stark and Parker 1995). Pure.
Eigen::VectorXf BoundedSolve(const Eigen::MatrixXf& a, const Eigen::VectorXf& b,
                             const Eigen::VectorXf& low, const Eigen::VectorXf& high);

}  // namespace facetrack
