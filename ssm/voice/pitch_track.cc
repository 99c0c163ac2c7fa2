#include "ssm/voice/pitch_track.h"

#include <algorithm>
#include <cmath>

namespace ssm {
namespace {

constexpr std::size_t kHopFrames = 5 * kFramesPerMs;
constexpr std::ptrdiff_t kWindow = 32 * static_cast<std::ptrdiff_t>(kFramesPerMs);
constexpr std::ptrdiff_t kLoudWindow = 10 * static_cast<std::ptrdiff_t>(kFramesPerMs);
constexpr auto kShortest = static_cast<std::ptrdiff_t>(kSampleRateHz / PitchTrack::kHighestHz);
constexpr auto kLongest = static_cast<std::ptrdiff_t>(kSampleRateHz / PitchTrack::kLowestHz);
constexpr double kVoiced = 0.5;
constexpr double kQuiet = 0.018;  // 35 dB below the loudest
// A shorter period that is nearly as good is the right one: two periods look alike too.
constexpr double kPreferShort = 0.9;

class Sound {
 public:
  explicit Sound(std::span<const std::int16_t> samples) : samples_(samples) {}
  double at(std::ptrdiff_t i) const {
    return i < 0 || i >= std::ssize(samples_) ? 0 : samples_[static_cast<std::size_t>(i)];
  }
  double Rms(std::ptrdiff_t middle) const {
    double power = 0;
    for (auto i = middle - kLoudWindow / 2; i < middle + kLoudWindow / 2; ++i)
      power += at(i) * at(i);
    return std::sqrt(power / kLoudWindow);
  }
  double Likeness(std::ptrdiff_t middle, std::ptrdiff_t lag) const {
    const std::ptrdiff_t begin = middle - (kWindow + lag) / 2;
    double product = 0, first = 0, second = 0;
    for (auto i = begin; i < begin + kWindow; ++i) {
      const double a = at(i), b = at(i + lag);
      product += a * b;
      first += a * a;
      second += b * b;
    }
    return product / std::sqrt(first * second + 1);
  }

 private:
  const std::span<const std::int16_t> samples_;
};

double PitchAt(const Sound& sound, std::ptrdiff_t middle) {
  std::vector<double> likeness;
  for (auto lag = kShortest; lag <= kLongest; ++lag) {
    likeness.push_back(sound.Likeness(middle, lag));
  }
  const double best = *std::max_element(likeness.begin(), likeness.end());
  if (best < kVoiced) return 0;
  for (std::size_t i = 1; i + 1 < likeness.size(); ++i) {
    const double here = likeness[i];
    if (here < kPreferShort * best || here < likeness[i - 1] || here < likeness[i + 1]) continue;
    // A parabola through the three finds the peak between samples.
    const double bend = likeness[i - 1] - 2 * here + likeness[i + 1];
    const double shift = bend < 0 ? 0.5 * (likeness[i - 1] - likeness[i + 1]) / bend : 0;
    return kSampleRateHz / (static_cast<double>(kShortest) + static_cast<double>(i) + shift);
  }
  return 0;
}

}  // namespace

PitchTrack MeasurePitch(std::span<const std::int16_t> samples) {
  const Sound sound(samples);
  PitchTrack track;
  for (std::size_t at = 0; at <= samples.size(); at += kHopFrames) {
    track.rms.push_back(sound.Rms(static_cast<std::ptrdiff_t>(at)));
  }
  const double loudest = *std::max_element(track.rms.begin(), track.rms.end());
  for (std::size_t i = 0; i < track.rms.size(); ++i) {
    const auto middle = static_cast<std::ptrdiff_t>(i * kHopFrames);
    track.hz.push_back(track.rms[i] < kQuiet * loudest ? 0 : PitchAt(sound, middle));
  }
  return track;
}

}  // namespace ssm
