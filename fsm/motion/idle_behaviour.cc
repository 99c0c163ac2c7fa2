#include "fsm/motion/idle_behaviour.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <ranges>

#include "fsm/motion/idle_kinds.h"
#include "fsm/motion/motion_errors.h"

namespace fsm {
namespace {

Angles Looped(const HeadCurve& curve, double ms) {
  return curve.At(std::fmod(std::max(0.0, ms), curve.length_ms()));
}

void Add(Angles& out, const Angles& more, double weight) {
  for (std::size_t i = 0; i < 3; ++i) out[i] += static_cast<float>(weight * more[i]);
}

// Returns a bump that rises from 0 at u = 0 to 1 in the middle and falls to 0 at u = 1.
double Swing(double u) {
  return u <= 0 || u >= 1 ? 0 : (1 - std::cos(u * 2 * std::numbers::pi)) / 2;
}

}  // namespace

IdleBehaviour::IdleBehaviour(const MotionPatterns& patterns, const GestureNumbers& gestures,
                             std::uint64_t seed)
    : patterns_(patterns), gestures_(gestures), seed_(seed) {
  switches_[static_cast<std::size_t>(IdleKind::kAsymmetry)] = {1, true, vm::Time(0), Track(1.0f)};
}

void IdleBehaviour::Set(vm::Time now, IdleKind kind, std::size_t pattern) {
  Switch& own = switches_[static_cast<std::size_t>(kind)];
  if (pattern > 0) {
    own.pattern = pattern;
    own.since = now;
  }
  own.on = pattern > 0;
  own.weight.MoveTo(now, own.on ? 1.0f : 0.0f, RowOf(kind).fade);
  if (kind == IdleKind::kBlink && own.on) blink_ = {};
}

vm::Result<void> IdleBehaviour::Set(vm::Time now, std::string_view kind, int pattern) {
  const auto named = IdleKindNamed(kind);
  if (!named) {
    return vm::Fail(
        vm::Errc::kBadValue,
        fmt::format("'{}' is nothing the face does by itself; {} expected", kind,
                    fmt::join(IdleKinds() | std::views::transform(&IdleKindRow::name), " ")));
  }
  if (pattern != 0) {
    const std::size_t count = RowOf(*named).count(patterns_);
    if (auto fits = CheckPattern(kind, pattern, 0, count); !fits) return fits;
  }
  Set(now, *named, static_cast<std::size_t>(pattern));
  return {};
}

vm::Result<void> IdleBehaviour::SetProfile(vm::Time now, std::string_view profile) {
  IdleProfile wanted{};
  if (profile == "OFF") {
    wanted[static_cast<std::size_t>(IdleKind::kAsymmetry)] = 1;
  } else {
    const auto found = patterns_.profiles.find(profile);
    if (found == patterns_.profiles.end()) {
      return vm::Fail(vm::Errc::kBadValue, fmt::format("'{}' is no way to live; {} or OFF expected",
                                                       profile, KeysOf(patterns_.profiles)));
    }
    wanted = found->second;
  }
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    const auto kind = static_cast<IdleKind>(i);
    // A configuration of the original may have fewer patterns than the tables of the profiles.
    const std::size_t pattern = std::min(wanted[i], RowOf(kind).count(patterns_));
    if (pattern != (On(kind) ? Pattern(kind) : 0)) Set(now, kind, pattern);
  }
  return {};
}

void IdleBehaviour::ForEachTrack(const TrackVisitor& visit) const {
  for (const Switch& own : switches_) visit(own.weight);
}

double IdleBehaviour::Random(RandomStream stream, std::int64_t index) const {
  return RandomAt(seed_, stream, index);
}

double IdleBehaviour::Wander(std::size_t wave, double periods) const {
  const auto stream =
      static_cast<RandomStream>(static_cast<std::size_t>(RandomStream::kHeadWander) + wave);
  const double cell = std::floor(periods);
  const auto index = static_cast<std::int64_t>(cell);
  const double u = SmootherStep(periods - cell);
  return Random(stream, index) * (1 - u) + Random(stream, index + 1) * u;
}

void IdleBehaviour::AddMove(vm::Time t, Angles& out) const {
  const Switch& own = Of(IdleKind::kMove);
  if (own.pattern == 0) return;
  const double weight = own.weight.At(t);
  if (!patterns_.auto_move_files.empty()) {
    Add(out, Looped(PatternAt(patterns_.auto_move_files, own.pattern), InMs(t - own.since)),
        weight);
    return;
  }
  const AutoMove& move = PatternAt(patterns_.auto_moves, own.pattern);
  const Angles amplitude{static_cast<float>(move.down), static_cast<float>(move.right),
                         static_cast<float>(move.tilt)};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double slow = InMs(t) / move.period_ms + 0.37 * static_cast<double>(axis);
    const double fast = slow * gestures_.wander.faster;
    const double way = gestures_.wander.slow * Wander(2 * axis, slow) +
                       gestures_.wander.fast * Wander(2 * axis + 1, fast);
    out[axis] += static_cast<float>(weight * way * amplitude[axis]);
  }
}

void IdleBehaviour::AddNods(vm::Time t, Angles& out) const {
  const Switch& own = Of(IdleKind::kNods);
  const double weight = own.weight.At(t);
  if (own.pattern == 0 || weight <= 0) return;
  const AutoNods& nods = PatternAt(patterns_.auto_nods, own.pattern);
  const double ms = InMs(t - own.since);
  const auto k = static_cast<std::int64_t>(std::floor(ms / nods.interval_ms));
  if (ms < 0) return;
  const auto varied = [&](glm::vec2 row, RandomStream stream) {
    return Linear(row, static_cast<float>(Random(stream, k)));
  };
  const double since =
      ms - nods.interval_ms *
               (static_cast<double>(k) + varied(gestures_.nod.begins, RandomStream::kNodTime));
  const double size = nods.angle * varied(gestures_.nod.size, RandomStream::kNodSize);
  const double down = Swing(since / gestures_.nod.lasts) +
                      gestures_.second_nod.size *
                          Swing((since - gestures_.second_nod.after) / gestures_.second_nod.lasts);
  out[kDown] += static_cast<float>(weight * size * down);
}

void IdleBehaviour::Contribute(vm::Time t, MotionLayers& layers) const {
  MotionLayer& layer = layers.Layer("idle");
  AddMove(t, layer.head);
  if (const Switch& own = Of(IdleKind::kUserdef); own.pattern > 0) {
    Add(layer.head, Looped(PatternAt(patterns_.auto_userdef, own.pattern), InMs(t - own.since)),
        own.weight.At(t));
  }
  if (const Switch& own = Of(IdleKind::kBreath); own.pattern > 0) {
    const double breath = BreathAt(t);
    layer.head[kDown] -=
        static_cast<float>(PatternAt(patterns_.auto_breaths, own.pattern).pitch * breath);
    const auto nostrils = static_cast<float>(gestures_.breath.nostrils * breath);
    layer.units.au.left[kNostrilDilator] = layer.units.au.right[kNostrilDilator] = nostrils;
  }
  layer.units.gaze.left = layer.units.gaze.right = EyesAt(t);
  layer.lids_shut = static_cast<float>(LidsShutAt(t));
  AddNods(t, layers.Layer("nods").head);
  if (const Switch& own = Of(IdleKind::kFace); own.pattern > 0) {
    AddTo(layers.Layer("idle_face").units, PatternAt(patterns_.auto_faces, own.pattern),
          own.weight.At(t));
  }
}

double IdleBehaviour::BreathAt(vm::Time t) const {
  const Switch& own = Of(IdleKind::kBreath);
  if (own.pattern == 0) return 0;
  const double ms = std::max(0.0, InMs(t - own.since));
  const double u = std::fmod(ms / PatternAt(patterns_.auto_breaths, own.pattern).period_ms, 1.0);
  const double in = gestures_.breath.in, out = gestures_.breath.out;
  return own.weight.At(t) * (u < in ? Eased(u / in) : 1 - Eased((u - in) / out));
}

EyeAngles IdleBehaviour::EyesAt(vm::Time t) const {
  const Switch& own = Of(IdleKind::kGaze);
  if (own.pattern == 0) return {};
  const AutoGaze& gaze = PatternAt(patterns_.auto_gazes, own.pattern);
  const double weight = own.weight.At(t);
  if (weight <= 0) return {};
  // One saccade at a random time in each interval, so that fixations vary widely in length.
  const auto jump_ms = [&](std::int64_t k) {
    return gaze.interval_ms *
           (static_cast<double>(k) + 0.5 + 0.45 * Random(RandomStream::kGazeTime, k));
  };
  const double now_ms = InMs(t);
  auto k = static_cast<std::int64_t>(std::floor(now_ms / gaze.interval_ms));
  if (now_ms < jump_ms(k)) --k;
  const auto place = [&](RandomStream stream, double share, std::int64_t index) {
    return share * gaze.amplitude * Random(stream, index);
  };
  const double x0 = place(RandomStream::kGazeX, 1, k - 1), x1 = place(RandomStream::kGazeX, 1, k);
  const double y0 = place(RandomStream::kGazeY, 0.6, k - 1),
               y1 = place(RandomStream::kGazeY, 0.6, k);
  // The main sequence of saccades: 21 ms and 2.2 ms a degree.
  const double u = SmootherStep((now_ms - jump_ms(k)) / (21 + 2.2 * std::hypot(x1 - x0, y1 - y0)));
  return {static_cast<float>(weight * (y0 + u * (y1 - y0))),
          static_cast<float>(weight * (x0 + u * (x1 - x0)))};
}

vm::Time IdleBehaviour::BlinkInterval(std::int64_t index) const {
  // Intervals between blinks are skewed: many short, some long. exp of a sum of three even numbers
  // (nearly normal) is nearly log-normal; bounded to half and one and a half of the mean.
  const double mean = PatternAt(patterns_.auto_blinks, Of(IdleKind::kBlink).pattern).interval_ms;
  const std::int64_t n = 3 * index;
  const double normal = Random(RandomStream::kBlinkTime, n) +
                        Random(RandomStream::kBlinkTime, n + 1) +
                        Random(RandomStream::kBlinkTime, n + 2);
  const double interval = mean * std::clamp(0.93 * std::exp(0.4 * normal), 0.5, 1.5);
  return FromMs(index == 0 ? 0.6 * interval : interval);
}

IdleBehaviour::Blink IdleBehaviour::LastBlink(vm::Time t) const {
  // The first interval begins when blinking is switched on.
  if (blink_.index < 0) blink_ = {-1, Of(IdleKind::kBlink).since};
  while (blink_.index >= 0 && blink_.start > t) {
    blink_.start -= BlinkInterval(blink_.index);
    --blink_.index;
  }
  for (;;) {
    const vm::Time next = blink_.start + BlinkInterval(blink_.index + 1);
    if (next > t) return blink_;
    blink_ = {blink_.index + 1, next};
  }
}

double IdleBehaviour::LidsShutAt(vm::Time t) const {
  const Switch& own = Of(IdleKind::kBlink);
  if (own.pattern == 0) return 0;
  const AutoBlink& blinks = PatternAt(patterns_.auto_blinks, own.pattern);
  const double weight = own.weight.At(t);
  if (weight <= 0) return 0;
  const Blink blink = LastBlink(t);
  if (blink.index < 0) return 0;
  // Half of people's blinks are incomplete.
  const double depth =
      blinks.varied ? std::min(1.0, 0.9 + 0.2 * Random(RandomStream::kBlinkDepth, blink.index)) : 1;
  return weight * depth * LidsAt(patterns_.blinks[blinks.blink], t - blink.start);
}

std::optional<vm::Time> IdleBehaviour::NextActivity(vm::Time t) const {
  for (const IdleKindRow& row : IdleKinds()) {
    if (row.moves_always && On(row.kind)) return t;
  }
  const std::optional<vm::Time> next = MotionSource::NextActivity(t);
  if (next && *next <= t) return t;
  if (!On(IdleKind::kBlink)) return next;
  const AutoBlink& blinks = PatternAt(patterns_.auto_blinks, Of(IdleKind::kBlink).pattern);
  const vm::Time length = LengthOf(patterns_.blinks[blinks.blink]);
  // Find the earliest blink that is not over, which follows the last one that is.
  const Blink over = LastBlink(t - length);
  return Earlier(next, std::max(t, over.start + BlinkInterval(over.index + 1)));
}

}  // namespace fsm
