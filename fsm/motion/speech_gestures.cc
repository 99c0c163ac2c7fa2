#include "fsm/motion/speech_gestures.h"

#include <algorithm>
#include <cmath>

#include "fsm/motion/easing.h"
#include "fsm/motion/random_streams.h"

namespace fsm {
namespace {

constexpr double kApartMs = 300;  // least distance between stressed vowels

/// Returns a bump from 0 to 1 and back; `row` has the time from its peak to the beat, and its rise
/// and fall times.
double Bump(const auto& row, double ms, double beat_ms) {
  const double after = ms - (beat_ms - row.before);
  return after <= 0 ? SmootherStep(1 + after / row.rise) : 1 - SmootherStep(after / row.fall);
}

}  // namespace

SpeechGestures::SpeechGestures(const VisemeTargets& visemes, const GestureNumbers& sizes,
                               std::uint64_t seed)
    : seed_(seed), length_ms_(visemes.length_ms), sizes_(sizes) {
  FindBeats(visemes);
  bool pause = true;
  for (const VisemeTarget& viseme : visemes.targets) {
    if (viseme.pause) {
      pause = pause || viseme.length_ms >= kPhrasePauseMs;
      continue;
    }
    if (!pause) continue;
    pause = false;
    const auto index = static_cast<std::int64_t>(phrases_.size());
    phrases_.push_back({std::max(-kApproachMs, viseme.start_ms - 150),
                        {.nod = Linear(sizes.phrase.nod, static_cast<float>(RandomAt(
                                                             seed_, RandomStream::kLift, index))),
                         .turn = RandomAt(seed_, RandomStream::kTurn, index),
                         .tilt = RandomAt(seed_, RandomStream::kTilt, index)}});
  }
}

void SpeechGestures::FindBeats(const VisemeTargets& visemes) {
  double sum = 0;
  double count = 0;
  for (const VisemeTarget& viseme : visemes.targets) {
    if (!viseme.dominance.vowel) continue;
    sum += viseme.length_ms;
    ++count;
  }
  if (count == 0) return;
  const double mean = sum / count;
  for (const VisemeTarget& viseme : visemes.targets) {
    if (!viseme.dominance.vowel) continue;
    const double open = std::clamp(viseme.target.mouth[kJawY] / 9.0, 0.0, 1.0);
    const double stress = std::min(2.2, viseme.length_ms / mean) * (0.7 + 0.3 * open);
    if (stress < 0.85) continue;
    const double nod = std::clamp(stress - 0.45, 0.3, 1.0);
    const Beat beat{viseme.start_ms + 0.4 * viseme.length_ms, nod, 0};
    if (!beats_.empty() && beat.peak_ms - beats_.back().peak_ms < kApartMs) {
      if (beats_.back().nod < nod) beats_.back() = beat;
    } else {
      beats_.push_back(beat);
    }
  }
  // The brows rise on the strongest beat of each second and a half.
  double last = -1e9;
  for (std::size_t i = 0; i < beats_.size(); ++i) {
    const bool strongest = (i == 0 || beats_[i - 1].nod <= beats_[i].nod) &&
                           (i + 1 == beats_.size() || beats_[i + 1].nod <= beats_[i].nod);
    const double chance =
        0.5 + 0.5 * RandomAt(seed_, RandomStream::kBrow, static_cast<std::int64_t>(i));
    if (!strongest || chance < 0.3 || beats_[i].peak_ms - last < 1500) continue;
    beats_[i].brow = std::clamp(beats_[i].nod * (0.6 + 0.4 * chance), 0.0, 1.0);
    last = beats_[i].peak_ms;
  }
}

SpeechGestures::At SpeechGestures::HeadAt(double position_ms) const {
  At out;
  if (phrases_.empty()) return out;
  for (const Phrase& phrase : phrases_) {
    const double u = SmootherStep((position_ms - phrase.start_ms) / sizes_.phrase.lasts);
    if (u <= 0) break;
    out.nod += u * (phrase.pose.nod - out.nod);
    out.turn += u * (phrase.pose.turn - out.turn);
    out.tilt += u * (phrase.pose.tilt - out.tilt);
  }
  for (const Beat& beat : beats_) {
    out.nod += beat.nod * (Bump(sizes_.stress, position_ms, beat.peak_ms) -
                           sizes_.lift.size * Bump(sizes_.lift, position_ms, beat.peak_ms));
    out.brow = std::max(out.brow, beat.brow * Bump(sizes_.brow, position_ms, beat.peak_ms));
  }
  out.nod += sizes_.sink.size *
             SmootherStep((position_ms - (length_ms_ - sizes_.sink.lasts)) / sizes_.sink.lasts);
  const double stays = SmootherStep((position_ms + kApproachMs) / 150) *
                       (1 - SmootherStep((position_ms - length_ms_) / kFadeMs));
  return {out.nod * stays, out.turn * stays, out.tilt * stays, out.brow * stays};
}

std::array<double, 2> SpeechGestures::AvertTimes(double shortest_ms) const {
  if (length_ms_ < shortest_ms || phrases_.empty()) return {0, 0};
  const double from = phrases_.front().start_ms + 20;
  const double longest = Linear(sizes_.avert.lasts,
                                static_cast<float>(RandomAt(seed_, RandomStream::kAvertLength, 0)));
  return {from, from + std::min(longest, sizes_.avert.part * length_ms_)};
}

std::array<double, 2> SpeechGestures::AvertAt(double position_ms, double shortest_ms) const {
  const auto [away, back] = AvertTimes(shortest_ms);
  if (back <= away) return {};
  // A saccade of ten degrees takes about 45 ms (main sequence).
  const double u =
      SmootherStep((position_ms - away) / 45) - SmootherStep((position_ms - back) / 45);
  const double side = RandomAt(seed_, RandomStream::kAvertSide, 0);
  return {u * (side > 0.2 ? -sizes_.avert.up : sizes_.avert.down),
          u * std::copysign(sizes_.avert.side, side)};
}

}  // namespace fsm
