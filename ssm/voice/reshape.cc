#include "ssm/voice/reshape.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace ssm {
namespace {

constexpr double kPulseHopFrames = 5 * kFramesPerMs;
constexpr double kUnvoicedPeriod = 5 * kFramesPerMs;
constexpr double kMostGain = 8;

/// One place a period in all that has voice, on the largest sample near by.
std::vector<double> FindPeriods(std::span<const std::int16_t> sound, const PitchTrack& track) {
  std::vector<double> marks;
  const auto size = static_cast<double>(sound.size());
  for (double at = 0; at < size;) {
    const double hz = ValueAt(track.hz, at);
    if (hz == 0) {
      at += kUnvoicedPeriod;
      continue;
    }
    const double period = kSampleRateHz / hz;
    const bool first = marks.empty() || at - marks.back() > 1.5 * period;
    const double reach = (first ? 0.5 : 0.2) * period;
    double best = at;
    int largest = std::numeric_limits<int>::min();
    for (double i = std::max(0.0, at - reach); i < std::min(size, at + reach); ++i) {
      const int value = sound[static_cast<std::size_t>(i)];
      if (value <= largest) continue;
      largest = value;
      best = std::floor(i);
    }
    if (!marks.empty() && best <= marks.back()) best = at;
    marks.push_back(best);
    at = best + period;
  }
  return marks;
}

/// Windowed pieces added up, with the sum of the windows beside them.
class Overlap {
 public:
  explicit Overlap(std::size_t frames) : sum_(frames), weight_(frames) {}
  void Add(std::span<const std::int16_t> sound, double from, double to, double half, double gain) {
    const auto reach = static_cast<std::ptrdiff_t>(half);
    for (std::ptrdiff_t i = -reach; i <= reach; ++i) {
      const auto source = static_cast<std::ptrdiff_t>(from) + i;
      const auto target = static_cast<std::ptrdiff_t>(to) + i;
      if (source < 0 || source >= std::ssize(sound) || target < 0 || target >= std::ssize(sum_)) {
        continue;
      }
      const double window =
          0.5 + 0.5 * std::cos(std::numbers::pi * static_cast<double>(i) / (half + 1));
      const auto at = static_cast<std::size_t>(target);
      sum_[at] += window * gain * sound[static_cast<std::size_t>(source)];
      weight_[at] += window;
    }
  }
  std::vector<std::int16_t> Samples() const {
    std::vector<std::int16_t> samples(sum_.size());
    for (std::size_t i = 0; i < samples.size(); ++i) {
      // Periods that overlap more do not fall together: they add up as noise does.
      const double value = sum_[i] / std::sqrt(std::max(weight_[i], 1.0));
      samples[i] = static_cast<std::int16_t>(std::lround(std::clamp(value, -32768.0, 32767.0)));
    }
    return samples;
  }

 private:
  std::vector<double> sum_, weight_;
};

}  // namespace

double ValueAt(const std::vector<double>& track, double frame) {
  if (track.empty()) return 0;
  const auto i = static_cast<std::size_t>(std::max(0.0, std::round(frame / kPulseHopFrames)));
  return track[std::min(i, track.size() - 1)];
}

SoundTrack::SoundTrack(std::span<const std::int16_t> sound)
    : sound_(sound), track_(MeasurePitch(sound)), periods_(FindPeriods(sound, track_)) {}

double SoundTrack::Hz(double frame) const { return ValueAt(track_.hz, frame); }
double SoundTrack::Rms(double frame) const { return ValueAt(track_.rms, frame); }

double SoundTrack::MeanHz(double begin, double end) const {
  double sum = 0;
  int count = 0;
  for (double at = begin; at < end; at += kPulseHopFrames) {
    const double hz = Hz(at);
    if (hz == 0) continue;
    sum += std::log(hz);
    ++count;
  }
  return count == 0 ? 0 : std::exp(sum / count);
}

double SoundTrack::NearestPeriod(double frame) const {
  const auto after = std::lower_bound(periods_.begin(), periods_.end(), frame);
  if (after == periods_.begin()) return periods_.empty() ? frame : *after;
  if (after == periods_.end()) return periods_.back();
  return *after - frame < frame - *std::prev(after) ? *after : *std::prev(after);
}

std::vector<std::int16_t> Reshaped(const SoundTrack& track, std::size_t frames,
                                   const std::function<SoundWish(double to)>& wish) {
  Overlap overlap(frames);
  for (double to = 0; to < static_cast<double>(frames);) {
    const SoundWish wanted = wish(to);
    const double hz = track.Hz(wanted.from);
    const bool voiced = hz > 0 && track.has_voice();
    const double own = voiced ? kSampleRateHz / hz : kUnvoicedPeriod;
    const double period = voiced && wanted.hz > 0 ? kSampleRateHz / wanted.hz : own;
    const double step = std::clamp(period, own / 2, own * 2);
    overlap.Add(track.sound(), voiced ? track.NearestPeriod(wanted.from) : wanted.from, to, own,
                std::clamp(wanted.gain, 0.0, kMostGain));
    to += step;
  }
  return overlap.Samples();
}

}  // namespace ssm
