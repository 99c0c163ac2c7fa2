#include "fsm/motion/speech/speech_gestures.h"

#include <algorithm>
#include <cmath>

#include "fsm/motion/base/easing.h"
#include "fsm/motion/base/random_streams.h"
#include "fsm/motion/speech/speech_timing.h"

namespace fsm {
namespace {

/// Returns a bump from 0 to 1 and back; `row` has the time from its peak to the beat, and its rise
/// and fall times.
double Bump(const auto& row, double ms, double beat_ms) {
  const double after = ms - (beat_ms - row.lead_ms);
  return after <= 0 ? SmootherStep(1 + after / row.rise_ms) : 1 - SmootherStep(after / row.fall_ms);
}

}  // namespace

SpeechGestures::SpeechGestures(const VisemeTargets& targets, const MovementNumbers& sizes,
                               std::uint64_t seed)
    : seed_(seed), length_ms_(targets.length_ms), sizes_(sizes) {
  FindBeats(targets);
  bool pause = true;
  for (const VisemeTarget& target : targets.targets) {
    if (target.pause) {
      pause = pause || target.length_ms >= kPhrasePauseMs;
      continue;
    }
    if (!pause) continue;
    pause = false;
    const auto index = static_cast<std::int64_t>(phrases_.size());
    phrases_.push_back({std::max(-kTransitionMs, target.start_ms - sizes.phrase.lead_ms),
                        {.nod = sizes.phrase.nod.At(
                             static_cast<float>(RandomAt(seed_, RandomStream::kLift, index))),
                         .turn = RandomAt(seed_, RandomStream::kTurn, index),
                         .tilt = RandomAt(seed_, RandomStream::kTilt, index)}});
  }
}

void SpeechGestures::FindBeats(const VisemeTargets& targets) {
  double sum = 0;
  double count = 0;
  for (const VisemeTarget& target : targets.targets) {
    if (!target.dominance.vowel) continue;
    sum += target.length_ms;
    ++count;
  }
  if (count == 0) return;
  const double mean = sum / count;
  for (const VisemeTarget& target : targets.targets) {
    if (!target.dominance.vowel) continue;
    const double open =
        std::clamp(target.pose.mouth[kJawY] / double{sizes_.vowel.open_jaw_deg}, 0.0, 1.0);
    const double stress = std::min(double{sizes_.vowel.max_length_ratio}, target.length_ms / mean) *
                          sizes_.vowel.stress.At(open);
    if (stress < sizes_.beat.min_stress) continue;
    const double nod =
        std::clamp(stress - sizes_.beat.nod_offset, double{sizes_.beat.min_nod}, 1.0);
    const Beat beat{target.start_ms + sizes_.beat.vowel_share * target.length_ms, nod, 0};
    if (!beats_.empty() && beat.peak_ms - beats_.back().peak_ms < sizes_.beat.min_interval_ms) {
      if (beats_.back().nod < nod) beats_.back() = beat;
    } else {
      beats_.push_back(beat);
    }
  }
  // The brows rise on beats that are stronger than their neighbours.
  double last = -1e9;
  for (std::size_t i = 0; i < beats_.size(); ++i) {
    const bool strongest = (i == 0 || beats_[i - 1].nod <= beats_[i].nod) &&
                           (i + 1 == beats_.size() || beats_[i + 1].nod <= beats_[i].nod);
    const double chance =
        0.5 + 0.5 * RandomAt(seed_, RandomStream::kBrow, static_cast<std::int64_t>(i));
    const MovementNumbers::Brow& brow = sizes_.brow;
    if (!strongest || chance < brow.skip_chance || beats_[i].peak_ms - last < brow.min_interval_ms)
      continue;
    beats_[i].brow = std::clamp(beats_[i].nod * brow.height.At(chance), 0.0, 1.0);
    last = beats_[i].peak_ms;
  }
}

SpeechGestures::HeadGesture SpeechGestures::HeadAt(double position_ms) const {
  HeadGesture out;
  if (phrases_.empty()) return out;
  for (const Phrase& phrase : phrases_) {
    const double u = SmootherStep((position_ms - phrase.start_ms) / sizes_.phrase.duration_ms);
    if (u <= 0) break;
    out.nod += u * (phrase.pose.nod - out.nod);
    out.turn += u * (phrase.pose.turn - out.turn);
    out.tilt += u * (phrase.pose.tilt - out.tilt);
  }
  for (const Beat& beat : beats_) {
    out.nod += beat.nod * (Bump(sizes_.stress, position_ms, beat.peak_ms) -
                           sizes_.upbeat.size * Bump(sizes_.upbeat, position_ms, beat.peak_ms));
    out.brow = std::max(out.brow, beat.brow * Bump(sizes_.brow, position_ms, beat.peak_ms));
  }
  out.nod += sizes_.final_lowering.size *
             SmootherStep((position_ms - (length_ms_ - sizes_.final_lowering.duration_ms)) /
                          sizes_.final_lowering.duration_ms);
  const double fade = SmootherStep((position_ms + kTransitionMs) / sizes_.speech.fade_in_ms) *
                      (1 - SmootherStep((position_ms - length_ms_) / InMs(kHeadReturns)));
  return {out.nod * fade, out.turn * fade, out.tilt * fade, out.brow * fade};
}

std::array<double, 2> SpeechGestures::AversionTimes(double shortest_ms) const {
  if (length_ms_ < shortest_ms || phrases_.empty()) return {0, 0};
  const double from = phrases_.front().start_ms + sizes_.avert.delay_ms;
  const double longest = sizes_.avert.duration_ms.At(
      static_cast<float>(RandomAt(seed_, RandomStream::kAvertLength, 0)));
  return {from, from + std::min(longest, sizes_.avert.max_share * length_ms_)};
}

std::array<double, 2> SpeechGestures::AvertedGazeAt(double position_ms, double shortest_ms) const {
  const auto [away, back] = AversionTimes(shortest_ms);
  if (back <= away) return {};
  const double u = SmootherStep((position_ms - away) / sizes_.avert.jump_ms) -
                   SmootherStep((position_ms - back) / sizes_.avert.jump_ms);
  const double side = RandomAt(seed_, RandomStream::kAvertSide, 0);
  return {u * (side > sizes_.avert.up_threshold ? -sizes_.avert.up : sizes_.avert.down),
          u * std::copysign(sizes_.avert.side, side)};
}

}  // namespace fsm
