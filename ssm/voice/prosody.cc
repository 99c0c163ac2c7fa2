#include "ssm/voice/prosody.h"

#include <algorithm>
#include <cmath>

#include "ssm/voice/pitch_track.h"
#include "ssm/voice/reshape.h"

namespace ssm {
namespace {

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
  const SoundTrack track(sound);
  const Warp back(prosody.phonemes, plan.phonemes);
  samples.Append(Reshaped(track, samples.size(), [&](double to) {
    const double from = back(to);
    const double own = track.Hz(from), wanted = ValueAt(prosody.f0, to);
    const double power = std::log(track.Rms(from) + 1);
    return SoundWish{.from = from,
                     .hz = own > 0 && wanted > 0 ? std::exp(wanted) : 0,
                     .gain = std::exp(ValueAt(prosody.power, to) - power)};
  }));
  samples.Finish();
}

}  // namespace ssm
