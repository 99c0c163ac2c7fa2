#include "fsm/motion/autonomy.h"

#include <cmath>

namespace fsm {
namespace {

using namespace std::chrono_literals;
constexpr vm::Time kFade = 400ms;

// Streams of random numbers, one for each thing that varies.
enum Stream : std::uint64_t { kBlinkTime, kBlinkDepth, kGazeTime, kGazeX, kGazeY, kHead };

// The finalizer of SplitMix64 (Steele, Lea, Flood 2014): every bit of the input matters.
std::uint64_t Scramble(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15u;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}

Angles Looped(const HeadCurve& curve, double ms) {
  return curve.At(std::fmod(std::max(0.0, ms), curve.length_ms()));
}

}  // namespace

void Autonomy::Switch::Set(vm::Time now, std::size_t wanted, vm::Time fade) {
  if (wanted > 0) {
    pattern = wanted;
    since = now;
  }
  on = wanted > 0;
  weight.MoveTo(now, on ? 1.0f : 0.0f, fade);
}

double Autonomy::Random(std::uint64_t stream, std::int64_t index) const {
  const std::uint64_t bits =
      Scramble(Scramble(seed_ * 64 + stream) ^ static_cast<std::uint64_t>(index));
  return static_cast<double>(bits >> 11) * 0x1p-52 - 1;
}

double Autonomy::Wander(std::uint64_t stream, double periods) const {
  const double cell = std::floor(periods);
  const auto index = static_cast<std::int64_t>(cell);
  const double u = SmootherStep(periods - cell);
  return Random(stream, index) * (1 - u) + Random(stream, index + 1) * u;
}

void Autonomy::Blink(vm::Time now, std::size_t pattern) { blink_.Set(now, pattern, 60ms); }
void Autonomy::Move(vm::Time now, std::size_t pattern) { move_.Set(now, pattern, kFade); }
void Autonomy::Gaze(vm::Time now, std::size_t pattern) { gaze_.Set(now, pattern, 60ms); }
void Autonomy::Userdef(vm::Time now, std::size_t pattern) { userdef_.Set(now, pattern, kFade); }

std::size_t Autonomy::MovePatterns(const MotionTable& table) {
  return table.auto_move_files.empty() ? table.auto_moves.size() : table.auto_move_files.size();
}

Angles Autonomy::HeadAt(vm::Time t) const {
  Angles out{};
  const auto add = [&out](const Angles& more, double weight) {
    for (std::size_t i = 0; i < 3; ++i) out[i] += static_cast<float>(weight * more[i]);
  };
  if (move_.pattern > 0) {
    const double weight = move_.weight.At(t);
    if (!table_.auto_move_files.empty()) {
      add(Looped(table_.auto_move_files[move_.pattern - 1], InMs(t - move_.since)), weight);
    } else {
      const AutoMove& move = table_.auto_moves[move_.pattern - 1];
      for (std::size_t axis = 0; axis < 3; ++axis) {
        // Two speeds together: one alone looks like a pendulum.
        const double slow = InMs(t) / move.period_ms + 0.37 * static_cast<double>(axis);
        const double way =
            0.75 * Wander(kHead + 2 * axis, slow) + 0.25 * Wander(kHead + 2 * axis + 1, slow * 2.3);
        out[axis] += static_cast<float>(weight * way * move.amplitude[axis]);
      }
    }
  }
  if (userdef_.pattern > 0) {
    add(Looped(table_.auto_userdef[userdef_.pattern - 1], InMs(t - userdef_.since)),
        userdef_.weight.At(t));
  }
  return out;
}

EyeAngles Autonomy::EyesAt(vm::Time t) const {
  if (gaze_.pattern == 0) return {};
  const AutoGaze& gaze = table_.auto_gazes[gaze_.pattern - 1];
  const double weight = gaze_.weight.At(t);
  if (weight <= 0) return {};
  // One jump in each interval, somewhere in its middle half.
  const auto jump_ms = [&](std::int64_t k) {
    return gaze.interval_ms * (static_cast<double>(k) + 0.5 + 0.25 * Random(kGazeTime, k));
  };
  const double now_ms = InMs(t);
  auto k = static_cast<std::int64_t>(std::floor(now_ms / gaze.interval_ms));
  if (now_ms < jump_ms(k)) --k;
  // A jump of two degrees takes about 26 ms (21 ms + 2.2 ms a degree, the usual main sequence).
  const double u = SmootherStep((now_ms - jump_ms(k)) / 30);
  const auto place = [&](std::uint64_t stream, double share) {
    return static_cast<float>(weight * share * gaze.amplitude *
                              (Random(stream, k - 1) * (1 - u) + Random(stream, k) * u));
  };
  return {place(kGazeY, 0.6), place(kGazeX, 1)};
}

vm::Time Autonomy::BlinkStart(std::int64_t index) const {
  // One blink in each interval, a quarter of it to either side of the middle: two are between half
  // and one and a half intervals apart.
  const double interval = table_.auto_blinks[blink_.pattern - 1].interval_ms;
  return FromMs(interval * (static_cast<double>(index) + 0.5 + 0.25 * Random(kBlinkTime, index)));
}

double Autonomy::LidsShutAt(vm::Time t) const {
  if (blink_.pattern == 0) return 0;
  const AutoBlink& blinks = table_.auto_blinks[blink_.pattern - 1];
  const double weight = blink_.weight.At(t);
  if (weight <= 0) return 0;
  const auto middle = static_cast<std::int64_t>(std::floor(InMs(t) / blinks.interval_ms));
  double shut = 0;
  for (std::int64_t k = middle - 1; k <= middle; ++k) {
    if (BlinkStart(k) < blink_.since) continue;
    const double depth = blinks.varied ? std::min(1.0, 0.85 + 0.25 * Random(kBlinkDepth, k)) : 1;
    shut = std::max(shut, depth * LidsAt(table_.blinks[blinks.blink], t - BlinkStart(k)));
  }
  return weight * shut;
}

std::optional<vm::Time> Autonomy::NextActivity(vm::Time t) const {
  const auto fading = [t](const Switch& s) { return s.weight.NextActivity(t).has_value(); };
  if (move_.on || userdef_.on || gaze_.on || fading(move_) || fading(userdef_) || fading(gaze_)) {
    return t;
  }
  if (!blink_.on) return fading(blink_) ? std::optional(t) : std::nullopt;
  const AutoBlink& blinks = table_.auto_blinks[blink_.pattern - 1];
  const vm::Time length = LengthOf(table_.blinks[blinks.blink]);
  for (auto k = static_cast<std::int64_t>(std::floor(InMs(t) / blinks.interval_ms)) - 1;; ++k) {
    const vm::Time start = BlinkStart(k);
    if (start >= blink_.since && t < start + length) return std::max(t, start);
  }
}

}  // namespace fsm
