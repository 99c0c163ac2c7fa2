#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>

namespace hypermask {

/// A way a coordinate may move: a linear system driven by white noise. Times in seconds, lengths in
/// pixels.
struct MotionModel {
  std::string name{};
  std::function<Eigen::MatrixXd(double seconds)> transition{};  ///< n x n
  Eigen::MatrixXd noise{};        ///< n x n: what a second adds to the covariance
  Eigen::RowVectorXd measured{};  ///< 1 x n: the coordinate out of the state
  Eigen::VectorXd spread{};       ///< n: standard deviations at the beginning, beside the place
};

/// x and its speed, driven by white acceleration (pixels^2/s^3).
MotionModel ConstantVelocity(double acceleration);
/// x, speed and an acceleration that dies away within `seconds` (Singer, IEEE Trans. AES 6, 1970),
/// driven by white jerk.
MotionModel DyingAcceleration(double seconds, double jerk);
/// A place that drifts, about which x swings at `hertz`: the linear oscillator, driven by white
/// acceleration.
MotionModel Oscillation(double hertz, double acceleration, double drift);

/// A Kalman filter (Gelb 1974) of several coordinates which all move by one model and are measured
/// at the same times, so that they share their covariance and gain.
/// Thread: one. Shapes: `measured` has one column, a row for each coordinate.
class Kalman {
 public:
  /// `noise`: standard deviation of what is measured, pixels.
  Kalman(MotionModel model, double noise);
  const std::string& name() const { return model_.name; }
  /// Begins anew at these places, at rest.
  void Begin(const Eigen::VectorXd& measured);
  /// After `seconds` this was measured.
  void Update(double seconds, const Eigen::VectorXd& measured);
  /// Where they will be `seconds` after the last measurement.
  Eigen::VectorXd Predict(double seconds) const;

 private:
  const MotionModel model_;
  const double variance_;
  Eigen::MatrixXd states_;      // n x coordinates
  Eigen::MatrixXd covariance_;  // n x n
};

}  // namespace hypermask
