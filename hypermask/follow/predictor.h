#pragma once

#include <deque>
#include <string>
#include <vector>

#include "hypermask/follow/kalman.h"
#include "hypermask/geometry/plane_map.h"

namespace hypermask {

/// How the delay of the chain is made up for.
enum class Prediction {
  kOff,     ///< not at all
  kSingle,  ///< one Kalman filter of constant velocity, as in the papers
  kBank,    ///< several filters, weighted by how well each has foretold the last half second
};

/// Foretells where points will be: each coordinate by itself, as in the HyperMask papers. Of a bank
/// (Magill, IEEE Trans. AC 10, 1965) every filter's word for `ahead` later is kept until that time
/// has come and then compared with what was measured. Pure: knows no clock. Thread: one.
/// Limits: kMostKept words of each filter wait.
class Predictor {
 public:
  static constexpr std::size_t kMostKept = 512;

  /// `ahead`: seconds, 0 to 2, the delay to be made up for; `noise`: of what is measured, pixels.
  Predictor(Prediction kind, double ahead, double noise = 0.15);
  /// Forgets all that was measured.
  void Forget();
  /// At `seconds`, later than the one before, the points were there. As many as before, or it
  /// begins anew.
  void Measure(double seconds, const Points& points);
  /// Where they will be at `seconds`. REQUIRES: something was measured.
  Points At(double seconds) const;
  bool empty() const { return last_.size() == 0; }
  /// Of the last measurement.
  double seconds() const { return seconds_; }
  /// The filter that counts most at present; for traces.
  const std::string& leader() const;

 private:
  struct Word {
    double seconds;
    Eigen::VectorXd places;
  };
  struct Member {
    Kalman filter;
    std::deque<Word> words{};
    double miss = 0;  // mean squared pixels of a coordinate, lately
  };
  void Compare(Member& member, double seconds, const Eigen::VectorXd& now) const;

  const Prediction kind_;
  const double ahead_;
  std::vector<Member> members_;
  double seconds_ = 0;
  Eigen::VectorXd last_;  // x y x y ...
};

}  // namespace hypermask
