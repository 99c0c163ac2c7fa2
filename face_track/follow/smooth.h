#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

namespace facetrack {

/// The filter of Casiez, Roussel and Vogel (1 Euro Filter, CHI 2012): a low-pass whose cutoff rises
/// with the speed, so that what is still does not tremble and what moves is hardly late. What is
/// slow it shows 1 / (2 pi cutoff) late.
class Smooth {
 public:
  /// `cutoff_hz` of what is still; `rise`: Hz more for one unit a second.
  Smooth(float cutoff_hz, float rise) : cutoff_hz_(cutoff_hz), rise_(rise) {}
  float operator()(float value, double seconds) {
    if (!last_ || !(seconds > 0)) return *(last_ = value);
    constexpr float kSpeedHz = 2;
    const auto t = static_cast<float>(seconds);
    speed_ += Gain(kSpeedHz, t) * ((value - *last_) / t - speed_);
    *last_ += Gain(cutoff_hz_ + rise_ * std::abs(speed_), t) * (value - *last_);
    return *last_;
  }
  void Forget() { last_.reset(), speed_ = 0; }

 private:
  static float Gain(float hz, float seconds) {
    const float r = 2 * std::numbers::pi_v<float> * hz * seconds;
    return r / (r + 1);
  }
  float cutoff_hz_, rise_, speed_ = 0;
  std::optional<float> last_;
};

}  // namespace facetrack
