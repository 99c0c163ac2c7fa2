#include "vdm/prosody/pitch_tracker.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace vdm {
namespace {

constexpr double kHalfRateHz = 8000;
constexpr double kPassHz = 1000;       // the low-pass filter's edge
constexpr std::size_t kShortest = 16;  // samples of a period at 8 kHz: 500 Hz
constexpr std::size_t kLongest = 134;  // 60 Hz
constexpr std::size_t kWindow = 200;   // 25 ms are compared
constexpr std::size_t kReach = PitchTracker::kReach;
static_assert(kReach > (kWindow + kLongest + 1) / 2);
constexpr std::size_t kHalfHop = PitchTracker::kHop / 2;

// As in Talkin's table 1, the cost of a change of voicing greater, since frames are 10 ms and what
// follows asks for few gaps.
constexpr float kLeastVoicing = 0.3F;  // of a candidate
constexpr float kNoVoiceCost =
    0.0F;  // beside the best candidate's voicing: over about 0.53 is a voice
constexpr float kLongPeriods = 0.3F;  // how much the longest period loses beside the shortest
constexpr float kOctaveCost = 0.35F;  // of a jump by an octave, less than its size says
constexpr float kPitchChange = 1.0F;  // per unit of the natural logarithm
constexpr float kVoicingChange = 0.14F;
// Power below which nothing is a voice: about -66 dB of full scale.
constexpr double kSilence = 250.0 * kWindow;

using Window = Eigen::Matrix<float, kWindow, 1>;

float Parabola(float before, float at, float after, float& value) {
  const float bend = before - 2 * at + after;
  const float shift = bend < 0 ? std::clamp(0.5F * (before - after) / bend, -0.5F, 0.5F) : 0;
  value = at - 0.25F * (before - after) * shift;
  return shift;
}

}  // namespace

PitchTracker::PitchTracker() {
  // A windowed sinc (Hamming).
  double sum = 0;
  for (std::size_t i = 0; i < kTaps; ++i) {
    const double x = static_cast<double>(i) - (kTaps - 1) / 2.0;
    const double turn = 2 * std::numbers::pi * kPassHz / (2 * kHalfRateHz);
    const double sinc =
        x == 0 ? turn / std::numbers::pi : std::sin(turn * x) / (std::numbers::pi * x);
    const double window = 0.54 + 0.46 * std::cos(2 * std::numbers::pi * x / (kTaps - 1));
    filter_[i] = static_cast<float>(sinc * window);
    sum += sinc * window;
  }
  for (float& tap : filter_) tap /= static_cast<float>(sum);
  sound_.assign((kTaps - 1) / 2, 0);  // silence before the first sample
  half_.assign(kReach, 0);
}

void PitchTracker::Halve(std::span<const std::int16_t> samples) {
  sound_.insert(sound_.end(), samples.begin(), samples.end());
  std::size_t at = 0;
  for (; at + kTaps <= sound_.size(); at += 2) {
    float value = 0;
    for (std::size_t i = 0; i < kTaps; ++i) value += filter_[i] * sound_[at + i];
    half_.push_back(value);
  }
  sound_.erase(sound_.begin(), sound_.begin() + static_cast<std::ptrdiff_t>(at));
}

PitchTracker::Column PitchTracker::Candidates(std::size_t centre) const {
  const float* const first = half_.data() + (centre - kReach);
  std::array<double, 2 * kReach + 1> energy{};  // of all samples before, from `first` on
  for (std::size_t i = 0; i < 2 * kReach; ++i) {
    energy[i + 1] = energy[i] + static_cast<double>(first[i] * first[i]);
  }
  // correlation[i]: of two windows kShortest - 1 + i samples apart, together around the centre.
  std::array<float, kLongest - kShortest + 3> correlation{};
  for (std::size_t i = 0; i < correlation.size(); ++i) {
    const std::size_t lag = kShortest - 1 + i;
    const std::size_t a = kReach - (kWindow + lag) / 2, b = a + lag;
    const Eigen::Map<const Window> one(first + a), other(first + b);
    const double energies =
        (energy[a + kWindow] - energy[a] + kSilence) * (energy[b + kWindow] - energy[b] + kSilence);
    correlation[i] = one.dot(other) / static_cast<float>(std::sqrt(energies));
  }
  Column column;
  for (std::size_t i = 1; i + 1 < correlation.size(); ++i) {
    const float before = correlation[i - 1], at = correlation[i], after = correlation[i + 1];
    if (at < kLeastVoicing || at < before || at <= after) continue;
    Candidate candidate;
    const float shift = Parabola(before, at, after, candidate.voicing);
    candidate.hz =
        static_cast<float>(kHalfRateHz) / (static_cast<float>(kShortest - 1 + i) + shift);
    column.push_back(candidate);
  }
  std::ranges::sort(column, std::ranges::greater{}, &Candidate::voicing);
  if (column.size() > kMostCandidates) column.resize(kMostCandidates);
  const float best = column.empty() ? 0 : column.front().voicing;
  for (Candidate& candidate : column) {
    const float longness = static_cast<float>(kHalfRateHz / kLongest) / candidate.hz;
    candidate.cost = 1 - candidate.voicing * (1 - kLongPeriods * longness);
  }
  column.push_back({.hz = 0, .voicing = best, .cost = kNoVoiceCost + best});
  return column;
}

void PitchTracker::Extend(Column column) {
  if (!columns_.empty()) {
    const Column& before = columns_.back();
    for (Candidate& now : column) {
      float least = std::numeric_limits<float>::max();
      for (std::size_t i = 0; i < before.size(); ++i) {
        float cost = before[i].cost;
        if ((before[i].hz == 0) != (now.hz == 0)) {
          cost += kVoicingChange;
        } else if (now.hz != 0) {
          const float way = std::abs(std::log(now.hz / before[i].hz));
          cost += kPitchChange *
                  std::min(way, kOctaveCost + std::abs(way - std::numbers::ln2_v<float>));
        }
        if (cost < least) least = cost, now.previous = i;
      }
      now.cost += least;
    }
    // Only differences count: the costs stay small however long the stream is.
    const float least = std::ranges::min_element(column, {}, &Candidate::cost)->cost;
    for (Candidate& now : column) now.cost -= least;
  }
  columns_.push_back(std::move(column));
  if (columns_.size() > kDecideAfter + 1) columns_.pop_front();
}

PitchTracker::Frame PitchTracker::Decided() const {
  const auto best = std::ranges::min_element(columns_.back(), {}, &Candidate::cost);
  auto index = static_cast<std::size_t>(best - columns_.back().begin());
  for (std::size_t i = columns_.size() - 1; i > 0; --i) index = columns_[i][index].previous;
  return {columns_.front()[index].hz, columns_.front()[index].voicing};
}

void PitchTracker::Add(std::span<const std::int16_t> samples, std::vector<Frame>& frames) {
  Halve(samples);
  for (;; ++next_frame_) {
    // half_ begins kReach samples before sample 0 of the stream.
    const std::size_t centre = next_frame_ * kHalfHop + kReach - half_begin_;
    if (centre + kReach > half_.size()) break;
    Extend(Candidates(centre));
    if (columns_.size() == kDecideAfter + 1) frames.push_back(Decided());
  }
  const std::size_t done = next_frame_ * kHalfHop - half_begin_;
  half_.erase(half_.begin(), half_.begin() + static_cast<std::ptrdiff_t>(done));
  half_begin_ += done;
}

}  // namespace vdm
