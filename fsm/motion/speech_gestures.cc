#include "fsm/motion/speech_gestures.h"

#include <algorithm>
#include <cmath>

#include "fsm/base/random.h"
#include "fsm/motion/easing.h"

namespace fsm {
namespace {

constexpr double kApartMs = 300;     // stressed vowels are at least so far apart
constexpr double kPoseMoveMs = 520;  // the head's way to the pose of a phrase
enum GestureStream : std::uint64_t { kTurn = 100, kTilt, kLift, kBrow, kAvertSide, kAvertLength };

// Up from 0 at peak - rise to 1 at the peak, and back at peak + fall.
double Bump(double ms, double peak, double rise, double fall) {
  if (ms <= peak) return SmootherStep((ms - (peak - rise)) / rise);
  return 1 - SmootherStep((ms - peak) / fall);
}

}  // namespace

SpeechGestures::SpeechGestures(const VisemeTargets& visemes, std::uint64_t seed)
    : seed_(seed), length_ms_(visemes.length_ms) {
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
                        {.nod = -0.35 + 0.3 * RandomAt(seed_, kLift, index),
                         .turn = RandomAt(seed_, kTurn, index),
                         .tilt = RandomAt(seed_, kTilt, index)}});
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
  // The brows go up on the strongest of each second and a half.
  double last = -1e9;
  for (std::size_t i = 0; i < beats_.size(); ++i) {
    const bool strongest = (i == 0 || beats_[i - 1].nod <= beats_[i].nod) &&
                           (i + 1 == beats_.size() || beats_[i + 1].nod <= beats_[i].nod);
    const double chance = 0.5 + 0.5 * RandomAt(seed_, kBrow, static_cast<std::int64_t>(i));
    if (!strongest || chance < 0.3 || beats_[i].peak_ms - last < 1500) continue;
    beats_[i].brow = std::clamp(beats_[i].nod * (0.6 + 0.4 * chance), 0.0, 1.0);
    last = beats_[i].peak_ms;
  }
}

SpeechGestures::At SpeechGestures::HeadAt(double position_ms) const {
  At out;
  if (phrases_.empty()) return out;
  for (const Phrase& phrase : phrases_) {
    const double u = SmootherStep((position_ms - phrase.start_ms) / kPoseMoveMs);
    if (u <= 0) break;
    out.nod += u * (phrase.pose.nod - out.nod);
    out.turn += u * (phrase.pose.turn - out.turn);
    out.tilt += u * (phrase.pose.tilt - out.tilt);
  }
  for (const Beat& beat : beats_) {
    // A small lift prepares the nod.
    out.nod += beat.nod * (Bump(position_ms, beat.peak_ms, 150, 330) -
                           0.25 * Bump(position_ms, beat.peak_ms - 170, 140, 120));
    out.brow = std::max(out.brow, beat.brow * Bump(position_ms, beat.peak_ms - 40, 180, 420));
  }
  // The head sinks a little with the last words.
  out.nod += 0.4 * SmootherStep((position_ms - (length_ms_ - 500)) / 500);
  const double stays = SmootherStep((position_ms + kApproachMs) / 150) *
                       (1 - SmootherStep((position_ms - length_ms_) / kFadeMs));
  return {out.nod * stays, out.turn * stays, out.tilt * stays, out.brow * stays};
}

std::array<double, 2> SpeechGestures::AvertTimes(double shortest_ms) const {
  if (length_ms_ < shortest_ms || phrases_.empty()) return {0, 0};
  const double from = phrases_.front().start_ms + 20;
  const double length = 650 + 350 * RandomAt(seed_, kAvertLength, 0);
  return {from, from + std::min(length, 0.45 * length_ms_)};
}

std::array<double, 2> SpeechGestures::AvertAt(double position_ms, double shortest_ms) const {
  const auto [away, back] = AvertTimes(shortest_ms);
  if (back <= away) return {};
  // The jumps of the eyes take about 45 ms at ten degrees (main sequence).
  const double u =
      SmootherStep((position_ms - away) / 45) - SmootherStep((position_ms - back) / 45);
  const double side = RandomAt(seed_, kAvertSide, 0);
  return {u * (side > 0.2 ? -0.5 : 0.45), u * std::copysign(0.8, side)};
}

}  // namespace fsm
