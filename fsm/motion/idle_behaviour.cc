#include "fsm/motion/idle_behaviour.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "fsm/motion/base/fixations.h"
#include "fsm/motion/base/layer_names.h"
#include "fsm/motion/inputs/idle_kinds.h"
#include "fsm/motion/inputs/motion_inputs.h"

namespace fsm {
namespace {

Angles Looped(const HeadCurve& curve, double ms) {
  return curve.At(std::fmod(std::max(0.0, ms), curve.length_ms()));
}

void Add(Angles& out, const Angles& more, double weight) {
  for (std::size_t i = 0; i < 3; ++i) out[i] += static_cast<float>(weight * more[i]);
}

// Returns a bump that rises from 0 at u = 0 to 1 in the middle and falls to 0 at u = 1.
double RaisedCosine(double u) {
  return u <= 0 || u >= 1 ? 0 : (1 - std::cos(u * 2 * std::numbers::pi)) / 2;
}

}  // namespace

IdleBehaviour::IdleBehaviour(const MotionInputs& in)
    : patterns_(in.tables.motions),
      gestures_(in.tables.gestures),
      switches_(in.switches),
      seed_(in.seed) {}

void IdleBehaviour::ForEachTrack(const TrackVisitor& visit) const {
  for (const IdleSwitches::Switch& own : switches_.all()) visit(own.runs);
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
  for (const IdleRun& run : switches_[IdleKind::kMove].runs.At(t)) {
    if (!patterns_.auto_move_files.empty()) {
      Add(out, Looped(PatternAt(patterns_.auto_move_files, run.pattern), InMs(t - run.since)),
          run.weight);
      continue;
    }
    const AutoMove& move = PatternAt(patterns_.auto_moves, run.pattern);
    const Angles amplitude{static_cast<float>(move.down), static_cast<float>(move.right),
                           static_cast<float>(move.tilt)};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double slow =
          InMs(t) / move.period_ms + gestures_.wander.axis_phase * static_cast<double>(axis);
      const double fast = slow * gestures_.wander.frequency_ratio;
      const double drift = gestures_.wander.slow_share * Wander(2 * axis, slow) +
                           gestures_.wander.fast_share * Wander(2 * axis + 1, fast);
      out[axis] += static_cast<float>(run.weight * drift * amplitude[axis]);
    }
  }
}

double IdleBehaviour::NodAt(const IdleRun& run, vm::Time t) const {
  const AutoNods& nods = PatternAt(patterns_.auto_nods, run.pattern);
  const double ms = InMs(t - run.since);
  if (ms < 0) return 0;
  const auto k = static_cast<std::int64_t>(std::floor(ms / nods.interval_ms));
  const auto varied = [&](Linear row, RandomStream stream) {
    return row.At(static_cast<float>(Random(stream, k)));
  };
  const double since =
      ms - nods.interval_ms *
               (static_cast<double>(k) + varied(gestures_.nod.begin_share, RandomStream::kNodTime));
  const double size = nods.angle * varied(gestures_.nod.size, RandomStream::kNodSize);
  const double down =
      RaisedCosine(since / gestures_.nod.duration_ms) +
      gestures_.second_nod.size *
          RaisedCosine((since - gestures_.second_nod.delay_ms) / gestures_.second_nod.duration_ms);
  return size * down;
}

void IdleBehaviour::Contribute(vm::Time t, MotionLayers& layers) const {
  MotionLayer& layer = layers.Layer(LayerName::kIdle);
  AddMove(t, layer.head_rotation);
  for (const IdleRun& run : switches_[IdleKind::kUserdef].runs.At(t)) {
    Add(layer.head_rotation,
        Looped(PatternAt(patterns_.auto_userdef, run.pattern), InMs(t - run.since)), run.weight);
  }
  float nostrils = 0;
  for (const IdleRun& run : switches_[IdleKind::kBreath].runs.At(t)) {
    const AutoBreath& pattern = PatternAt(patterns_.auto_breaths, run.pattern);
    const double breath = run.weight * BreathAt(pattern, t - run.since);
    layer.head_rotation[kDown] -= static_cast<float>(pattern.pitch * breath);
    nostrils += static_cast<float>(gestures_.breath.nostrils * breath);
  }
  layer.look.au.left[kNostrilDilator] = layer.look.au.right[kNostrilDilator] = nostrils;
  EyeAngles gaze{};
  for (const IdleRun& run : switches_[IdleKind::kGaze].runs.At(t)) {
    const EyeAngles saccades = SaccadesAt(PatternAt(patterns_.auto_gazes, run.pattern), t);
    for (std::size_t i = 0; i < 2; ++i) gaze[i] += run.weight * saccades[i];
  }
  layer.look.gaze.left = layer.look.gaze.right = gaze;
  layer.blink.left = layer.blink.right = static_cast<float>(BlinkAt(t));
  for (const IdleRun& run : switches_[IdleKind::kNods].runs.At(t)) {
    layers.Layer(LayerName::kNods).head_rotation[kDown] +=
        static_cast<float>(run.weight * NodAt(run, t));
  }
  for (const IdleRun& run : switches_[IdleKind::kFace].runs.At(t)) {
    AddTo(layers.Layer(LayerName::kIdleFace).look, PatternAt(patterns_.auto_faces, run.pattern),
          run.weight);
  }
}

double IdleBehaviour::BreathAt(const AutoBreath& pattern, vm::Time since) const {
  const double u = std::fmod(std::max(0.0, InMs(since)) / pattern.period_ms, 1.0);
  const double in = gestures_.breath.inhale_share, out = gestures_.breath.exhale_share;
  return u < in ? SmoothStep(u / in) : 1 - SmoothStep((u - in) / out);
}

EyeAngles IdleBehaviour::SaccadesAt(const AutoGaze& gaze, vm::Time t) const {
  const MovementNumbers::Saccade& saccade = gestures_.saccade;
  const auto saccade_ms = [&](std::int64_t k) {
    return gaze.interval_ms * (static_cast<double>(k) + saccade.begin_share.start +
                               saccade.begin_share.added * Random(RandomStream::kGazeTime, k));
  };
  const auto place = [&](std::int64_t k) -> std::array<double, 2> {
    return {saccade.height_ratio * gaze.angle * Random(RandomStream::kGazeY, k),
            gaze.angle * Random(RandomStream::kGazeX, k)};
  };
  const auto jump_ms = [&](const auto& from, const auto& to) {
    return saccade.base_ms + saccade.ms_per_degree * std::hypot(to[0] - from[0], to[1] - from[1]);
  };
  return FixationAt(InMs(t), gaze.interval_ms, saccade_ms, place, jump_ms);
}

vm::Time IdleBehaviour::BlinkInterval(std::size_t pattern, std::int64_t index) const {
  const double mean = PatternAt(patterns_.auto_blinks, pattern).interval_ms;
  const std::int64_t n = 3 * index;
  const double normal = Random(RandomStream::kBlinkTime, n) +
                        Random(RandomStream::kBlinkTime, n + 1) +
                        Random(RandomStream::kBlinkTime, n + 2);
  const MovementNumbers::Blink& blink = gestures_.blink;
  const double interval = mean * std::clamp(blink.median * std::exp(blink.log_spread * normal),
                                            double{blink.shortest}, double{blink.longest});
  return FromMs(index == 0 ? blink.first * interval : interval);
}

IdleBehaviour::Blink IdleBehaviour::LastBlink(std::size_t pattern, vm::Time since,
                                              vm::Time t) const {
  Blink& blink = cache_.blink;
  if (cache_.since != since || cache_.pattern != pattern || blink.index < 0) {
    cache_ = {since, pattern, {-1, since}};  // the first interval begins there
  }
  while (blink.index >= 0 && blink.start > t) {
    blink.start -= BlinkInterval(pattern, blink.index);
    --blink.index;
  }
  for (;;) {
    const vm::Time next = blink.start + BlinkInterval(pattern, blink.index + 1);
    if (next > t) return blink;
    blink = {blink.index + 1, next};
  }
}

double IdleBehaviour::BlinkAt(vm::Time t) const {
  double shut = 0;
  for (const IdleRun& run : switches_[IdleKind::kBlink].runs.At(t)) {
    const AutoBlink& blinks = PatternAt(patterns_.auto_blinks, run.pattern);
    const Blink blink = LastBlink(run.pattern, run.since, t);
    if (blink.index < 0) continue;
    const double depth = blinks.varied ? std::min(1.0, gestures_.blink.depth.At(Random(
                                                           RandomStream::kBlinkDepth, blink.index)))
                                       : 1;
    shut += run.weight * depth * LidsAt(patterns_.blinks[blinks.blink], t - blink.start);
  }
  return shut;
}

std::optional<vm::Time> IdleBehaviour::NextMotion(vm::Time t) const {
  for (const IdleKindRow& row : IdleKinds()) {
    if (row.moves_always && switches_[row.kind].on()) return t;
  }
  const std::optional<vm::Time> next = MotionSource::NextMotion(t);
  if (next && *next <= t) return t;
  const IdleSwitches::Switch& own = switches_[IdleKind::kBlink];
  if (!own.on()) return next;
  const AutoBlink& blinks = PatternAt(patterns_.auto_blinks, own.pattern);
  const vm::Time length = LengthOf(patterns_.blinks[blinks.blink]);
  // Find the earliest blink that is not over, which follows the last one that is.
  const Blink over = LastBlink(own.pattern, own.since, t - length);
  return Earlier(next, std::max(t, over.start + BlinkInterval(own.pattern, over.index + 1)));
}

}  // namespace fsm
