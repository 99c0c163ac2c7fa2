#include "hypermask/follow/predictor.h"

#include <algorithm>
#include <cmath>

namespace hypermask {
namespace {

/// How long a filter's errors count, seconds.
constexpr double kMemory = 0.5;
/// Errors below this, pixels, tell nothing.
constexpr double kAlike = 0.1;
/// The power of the mean squared error by which filters are weighted.
constexpr double kSharpness = 3;
/// After so long without a measurement what was known of speeds is of no use.
constexpr double kGap = 0.5;

std::vector<MotionModel> Models(Prediction kind) {
  // Pixels of a camera of about 640 x 480. Orders of magnitude, for people who walk and shake their
  // heads; not fitted to the simulated movements.
  constexpr double kAcceleration = 3e4, kJerk = 3e7, kDrift = 3e3;
  if (kind == Prediction::kOff) return {};
  if (kind == Prediction::kSingle) return {ConstantVelocity(kAcceleration)};
  std::vector<MotionModel> models{ConstantVelocity(kAcceleration),
                                  ConstantVelocity(kAcceleration / 30),
                                  DyingAcceleration(0.1, kJerk), DyingAcceleration(0.3, kJerk / 3),
                                  DyingAcceleration(1, kJerk / 30)};
  for (const double hertz : {0.5, 0.75, 1.0, 1.25, 1.5, 1.75, 2.0, 2.25, 2.5, 3.0}) {
    models.push_back(Oscillation(hertz, kAcceleration / 10, kDrift));
  }
  return models;
}

Eigen::VectorXd Flat(const Points& points) {
  Eigen::VectorXd flat(2 * static_cast<Eigen::Index>(points.size()));
  for (std::size_t i = 0; i < points.size(); ++i) {
    flat.segment<2>(2 * static_cast<Eigen::Index>(i)) = points[i];
  }
  return flat;
}

}  // namespace

Predictor::Predictor(Prediction kind, double ahead, double noise)
    : kind_(kind), ahead_(std::clamp(ahead, 0.0, 2.0)) {
  for (MotionModel& model : Models(kind)) members_.push_back({Kalman(std::move(model), noise)});
}

void Predictor::Forget() {
  last_.resize(0);
  for (Member& member : members_) {
    member.words.clear();
    member.miss = 0;
  }
}

void Predictor::Measure(double seconds, const Points& points) {
  const Eigen::VectorXd now = Flat(points);
  if (now.size() != last_.size() || seconds - seconds_ > kGap || seconds <= seconds_) {
    Forget();
    for (Member& member : members_) member.filter.Begin(now);
  } else {
    for (Member& member : members_) {
      Compare(member, seconds, now);
      member.filter.Update(seconds - seconds_, now);
    }
  }
  last_ = now;
  seconds_ = seconds;
  if (kind_ != Prediction::kBank) return;
  for (Member& member : members_) {
    if (member.words.size() == kMostKept) member.words.pop_front();
    member.words.push_back({seconds + ahead_, member.filter.Predict(ahead_)});
  }
}

void Predictor::Compare(Member& member, double seconds, const Eigen::VectorXd& now) const {
  while (!member.words.empty() && member.words.front().seconds <= seconds) {
    const Word& word = member.words.front();
    if (word.seconds > seconds_) {
      const double part = (word.seconds - seconds_) / (seconds - seconds_);
      const double miss = (last_ + part * (now - last_) - word.places).squaredNorm() /
                          static_cast<double>(now.size());
      const double weight = 1 - std::exp(-(seconds - seconds_) / kMemory);
      member.miss += weight * (miss - member.miss);
    }
    member.words.pop_front();
  }
}

Points Predictor::At(double seconds) const {
  const double ahead = seconds - seconds_;
  Eigen::VectorXd places = last_;
  if (!members_.empty() && ahead > 0) {
    places.setZero();
    double sum = 0;
    for (const Member& member : members_) {
      const double weight = std::pow(member.miss + kAlike * kAlike, -kSharpness);
      places += weight * member.filter.Predict(ahead);
      sum += weight;
    }
    places /= sum;
  }
  Points points;
  for (Eigen::Index i = 0; i + 1 < places.size(); i += 2) points.push_back(places.segment<2>(i));
  return points;
}

const std::string& Predictor::leader() const {
  static const std::string none = "none";
  if (members_.empty()) return none;
  return std::ranges::min_element(members_, {}, &Member::miss)->filter.name();
}

}  // namespace hypermask
