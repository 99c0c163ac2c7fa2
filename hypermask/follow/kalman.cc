#include "hypermask/follow/kalman.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

namespace hypermask {

MotionModel ConstantVelocity(double acceleration) {
  MotionModel model{.name = "velocity",
                    .transition =
                        [](double t) {
                          Eigen::MatrixXd f(2, 2);
                          f << 1, t, 0, 1;
                          return f;
                        },
                    .noise = Eigen::MatrixXd::Zero(2, 2),
                    .measured = Eigen::RowVectorXd::Zero(2),
                    .spread = Eigen::VectorXd::Zero(2)};
  model.noise(1, 1) = acceleration;
  model.measured[0] = 1;
  model.spread << 1, 200;
  return model;
}

MotionModel DyingAcceleration(double seconds, double jerk) {
  MotionModel model{.name = fmt::format("acceleration {:g} s", seconds),
                    .transition =
                        [a = 1 / seconds](double t) {
                          const double e = std::exp(-a * t);
                          Eigen::MatrixXd f(3, 3);
                          f << 1, t, (a * t - 1 + e) / (a * a), 0, 1, (1 - e) / a, 0, 0, e;
                          return f;
                        },
                    .noise = Eigen::MatrixXd::Zero(3, 3),
                    .measured = Eigen::RowVectorXd::Zero(3),
                    .spread = Eigen::VectorXd::Zero(3)};
  model.noise(2, 2) = jerk;
  model.measured[0] = 1;
  model.spread << 1, 200, 1000;
  return model;
}

MotionModel Oscillation(double hertz, double acceleration, double drift) {
  MotionModel model{.name = fmt::format("oscillation {:g} Hz", hertz),
                    .transition =
                        [w = 2 * std::numbers::pi * hertz](double t) {
                          const double c = std::cos(w * t), s = std::sin(w * t);
                          Eigen::MatrixXd f = Eigen::MatrixXd::Zero(4, 4);
                          f << 1, t, 0, 0, 0, 1, 0, 0, 0, 0, c, s / w, 0, 0, -w * s, c;
                          return f;
                        },
                    .noise = Eigen::MatrixXd::Zero(4, 4),
                    .measured = Eigen::RowVectorXd::Zero(4),
                    .spread = Eigen::VectorXd::Zero(4)};
  model.noise(1, 1) = drift;
  model.noise(3, 3) = acceleration;
  model.measured << 1, 0, 1, 0;
  model.spread << 1, 100, 10, 200;
  return model;
}

Kalman::Kalman(MotionModel model, double noise)
    : model_(std::move(model)), variance_(noise * noise) {}

void Kalman::Begin(const Eigen::VectorXd& measured) {
  states_ = Eigen::MatrixXd::Zero(model_.measured.size(), measured.size());
  states_.row(0) = measured.transpose();
  covariance_ = model_.spread.array().square().matrix().asDiagonal();
}

void Kalman::Update(double seconds, const Eigen::VectorXd& measured) {
  const Eigen::MatrixXd f = model_.transition(seconds);
  states_ = (f * states_).eval();
  covariance_ = (f * covariance_ * f.transpose() + seconds * model_.noise).eval();
  const double innovation =
      (model_.measured * covariance_ * model_.measured.transpose()).value() + variance_;
  const Eigen::VectorXd gain = covariance_ * model_.measured.transpose() / innovation;
  states_ += gain * (measured.transpose() - model_.measured * states_);
  // Joseph's form keeps it symmetric and positive.
  const auto n = covariance_.rows();
  const Eigen::MatrixXd rest = Eigen::MatrixXd::Identity(n, n) - gain * model_.measured;
  covariance_ =
      (rest * covariance_ * rest.transpose() + variance_ * gain * gain.transpose()).eval();
}

Eigen::VectorXd Kalman::Predict(double seconds) const {
  return (model_.measured * (model_.transition(seconds) * states_)).transpose();
}

}  // namespace hypermask
