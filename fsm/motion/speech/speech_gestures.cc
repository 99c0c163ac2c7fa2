#include "fsm/motion/speech/speech_gestures.h"

#include <algorithm>
#include <cmath>

#include "fsm/motion/base/easing.h"
#include "fsm/motion/base/random_streams.h"
#include "fsm/motion/speech/speech_timing.h"

namespace fsm {
namespace {

// Phrases and stress. The numbers are ours, tuned by eye; gestures.txt has the sizes of movements.
constexpr double kPhraseLeadMs = 150;  // the head moves so long before the first sound of a phrase
constexpr double kAwayMs = 20;         // from there, until the eyes are averted
constexpr double kFadeInMs = 150;      // of all gestures
constexpr double kAversionSaccadeMs = 45;  // of ten degrees, by the main sequence
constexpr double kLooksUpAbove = 0.2;      // of -1..1: else the averted gaze goes down
constexpr double kOpenJawDegrees = 9;      // of a fully open vowel
constexpr double kMostLength = 2.2;        // of a vowel, relative to the mean
constexpr double kClosedStress = 0.7,
                 kOpenStress = 0.3;    // of a closed vowel, and what the jaw adds
constexpr double kLeastStress = 0.85;  // of a beat; 1 = a vowel of mean length, fully open
constexpr double kStressWithoutNod = 0.45;
constexpr double kLeastNod = 0.3;       // 1 = the greatest nod
constexpr double kBeatAt = 0.4;         // share of the vowel before the beat
constexpr double kApartMs = 300;        // least distance of beats
constexpr double kBrowsApartMs = 1500;  // least distance of beats with raised brows
constexpr double kBrowsRest = 0.3;      // share of the strongest beats without raised brows
constexpr double kLeastBrow = 0.6, kVariedBrow = 0.4;  // height of the brows relative to the nod

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
    phrases_.push_back({std::max(-kTransitionMs, viseme.start_ms - kPhraseLeadMs),
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
    const double open = std::clamp(viseme.pose.mouth[kJawY] / kOpenJawDegrees, 0.0, 1.0);
    const double stress =
        std::min(kMostLength, viseme.length_ms / mean) * (kClosedStress + kOpenStress * open);
    if (stress < kLeastStress) continue;
    const double nod = std::clamp(stress - kStressWithoutNod, kLeastNod, 1.0);
    const Beat beat{viseme.start_ms + kBeatAt * viseme.length_ms, nod, 0};
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
    if (!strongest || chance < kBrowsRest || beats_[i].peak_ms - last < kBrowsApartMs) continue;
    beats_[i].brow = std::clamp(beats_[i].nod * (kLeastBrow + kVariedBrow * chance), 0.0, 1.0);
    last = beats_[i].peak_ms;
  }
}

SpeechGestures::HeadGesture SpeechGestures::HeadAt(double position_ms) const {
  HeadGesture out;
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
  const double fade = SmootherStep((position_ms + kTransitionMs) / kFadeInMs) *
                      (1 - SmootherStep((position_ms - length_ms_) / InMs(kHeadReturns)));
  return {out.nod * fade, out.turn * fade, out.tilt * fade, out.brow * fade};
}

std::array<double, 2> SpeechGestures::AversionTimes(double shortest_ms) const {
  if (length_ms_ < shortest_ms || phrases_.empty()) return {0, 0};
  const double from = phrases_.front().start_ms + kAwayMs;
  const double longest = Linear(sizes_.avert.lasts,
                                static_cast<float>(RandomAt(seed_, RandomStream::kAvertLength, 0)));
  return {from, from + std::min(longest, sizes_.avert.part * length_ms_)};
}

std::array<double, 2> SpeechGestures::AvertedGazeAt(double position_ms, double shortest_ms) const {
  const auto [away, back] = AversionTimes(shortest_ms);
  if (back <= away) return {};
  const double u = SmootherStep((position_ms - away) / kAversionSaccadeMs) -
                   SmootherStep((position_ms - back) / kAversionSaccadeMs);
  const double side = RandomAt(seed_, RandomStream::kAvertSide, 0);
  return {u * (side > kLooksUpAbove ? -sizes_.avert.up : sizes_.avert.down),
          u * std::copysign(sizes_.avert.side, side)};
}

}  // namespace fsm
