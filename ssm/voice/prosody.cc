#include "ssm/voice/prosody.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "ssm/voice/pitch_track.h"

namespace ssm {
namespace {

constexpr double kHopFrames = 5 * kFramesPerMs;
constexpr double kUnvoicedPeriod = 5 * kFramesPerMs;
constexpr double kMostGain = 8;

/// Times of one utterance as times of the other, phoneme by phoneme.
class Warp {
 public:
  Warp(const vm::PhonemeList& from, const vm::PhonemeList& to) {
    Millis a{0}, b{0};
    points_.emplace_back(0, 0);
    for (std::size_t i = 0; i < from.size(); ++i) {
      a += from[i].duration;
      b += to[i].duration;
      points_.emplace_back(ToFrames(a), ToFrames(b));
    }
  }
  double operator()(double at) const {
    for (std::size_t i = 1; i < points_.size(); ++i) {
      const auto [a, b] = points_[i];
      const auto [a0, b0] = points_[i - 1];
      if (at <= a && a > a0) return b0 + (at - a0) * (b - b0) / (a - a0);
    }
    return points_.back().second;
  }

 private:
  std::vector<std::pair<double, double>> points_;
};

double At(const std::vector<double>& track, double frame) {
  if (track.empty()) return 0;
  const auto i = static_cast<std::size_t>(std::max(0.0, std::round(frame / kHopFrames)));
  return track[std::min(i, track.size() - 1)];
}

/// One place a period in all that has voice, on the largest sample near by.
std::vector<double> PitchMarks(const std::vector<std::int16_t>& sound, const PitchTrack& track) {
  std::vector<double> marks;
  const auto size = static_cast<double>(sound.size());
  for (double at = 0; at < size;) {
    const double hz = At(track.hz, at);
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

double Nearest(const std::vector<double>& marks, double at) {
  const auto after = std::lower_bound(marks.begin(), marks.end(), at);
  if (after == marks.begin()) return marks.empty() ? at : *after;
  if (after == marks.end()) return marks.back();
  return *after - at < at - *std::prev(after) ? *after : *std::prev(after);
}

/// Windowed pieces added up, with the sum of the windows beside them.
class Overlap {
 public:
  explicit Overlap(std::size_t frames) : sum_(frames), weight_(frames) {}
  void Add(const std::vector<std::int16_t>& sound, double from, double to, double half,
           double gain) {
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

Prosody ProsodyOf(const Utterance& utterance) {
  const PitchTrack track = MeasurePitch(utterance.samples->Ready());
  Prosody prosody{utterance.text, utterance.spoken_text, utterance.plan.phonemes, {}, {}};
  for (const double hz : track.hz) prosody.f0.push_back(hz > 0 ? std::log(hz) : 0);
  for (const double rms : track.rms) prosody.power.push_back(std::log(rms + 1));
  return prosody;
}

vm::Result<SpeechPlan> Retimed(const SpeechPlan& plan, const Prosody& prosody) {
  const bool same = std::equal(plan.phonemes.begin(), plan.phonemes.end(), prosody.phonemes.begin(),
                               prosody.phonemes.end(),
                               [](const auto& a, const auto& b) { return a.name == b.name; });
  if (!same) {
    return vm::Fail(vm::Errc::kBadValue,
                    "the phonemes are not those of the text with this speaker, expected " +
                        vm::FormatPhonemesVoice(plan.phonemes).substr(0, 200));
  }
  const Warp warp(plan.phonemes, prosody.phonemes);
  const auto moved = [&](Millis at) {
    return ToMs(static_cast<std::size_t>(warp(static_cast<double>(ToFrames(at)))));
  };
  SpeechPlan retimed = plan;
  retimed.phonemes = prosody.phonemes;
  for (WordTime& word : retimed.words) {
    word.start = moved(word.start);
    word.end = moved(word.end);
  }
  for (MarkTime& mark : retimed.marks) mark.at = moved(mark.at);
  return retimed;
}

void Reshape(const std::vector<std::int16_t>& sound, const SpeechPlan& plan, const Prosody& prosody,
             SampleBuffer& samples) {
  const PitchTrack track = MeasurePitch(sound);
  const std::vector<double> marks = PitchMarks(sound, track);
  const Warp back(prosody.phonemes, plan.phonemes);
  Overlap overlap(samples.size());
  for (double to = 0; to < static_cast<double>(samples.size());) {
    const double from = back(to);
    const double hz = At(track.hz, from);
    const double wanted = At(prosody.f0, to);
    const bool voiced = hz > 0 && wanted > 0 && !marks.empty();
    const double own = voiced ? kSampleRateHz / hz : kUnvoicedPeriod;
    const double step =
        voiced ? std::clamp(kSampleRateHz / std::exp(wanted), own / 2, own * 2) : kUnvoicedPeriod;
    const double power = std::log(At(track.rms, from) + 1);
    const double gain = std::clamp(std::exp(At(prosody.power, to) - power), 0.0, kMostGain);
    overlap.Add(sound, voiced ? Nearest(marks, from) : from, to, own, gain);
    to += step;
  }
  samples.Append(overlap.Samples());
  samples.Finish();
}

}  // namespace ssm
