#include "fsm/motion/viseme_target.h"

#include <algorithm>

#include "fsm/motion/easing.h"

namespace fsm {
namespace {

constexpr double kLongMs = 200;          // from here on a phoneme holds and then moves
constexpr double kFirstPartShare = 0.3;  // of a diphthong

MouthPose Scaled(const Viseme& shape, double strength, const LipStyle& style) {
  MouthPose pose = shape.pose;
  // A contact is the same however large the movements are; a weak one is still a contact, so the
  // seal is left alone.
  const double most = pose.contact > 0 ? 1 : 3;
  for (std::size_t i = 0; i < kMouthParameters; ++i) {
    const double scale = i == kJawY || i == kJawZ ? style.jaw : style.lips;
    pose.mouth[i] = static_cast<float>(pose.mouth[i] * strength * std::clamp(scale, 0.0, most));
  }
  return pose;
}

struct TimedPhase {
  double start_ms;
  double length_ms;
  PhonemeShapes::Phase phase;
  bool holds;
};

// "next" takes over what follows; at the end, or before a closure of the lips, there is only rest.
void ResolveNext(std::vector<TimedPhase>& phases, const MouthSet& set) {
  for (std::size_t i = phases.size(); i-- > 0;) {
    PhonemeShapes::Phase& phase = phases[i].phase;
    if (phase.shape != PhonemeShapes::kNext) continue;
    const bool follows = i + 1 < phases.size();
    phase.shape = follows ? phases[i + 1].phase.shape : static_cast<int>(set.rest);
    const bool closes = set.shapes[static_cast<std::size_t>(phase.shape)].pose.seal > 0;
    phase.strength *= follows && !closes ? phases[i + 1].phase.strength : 0;
  }
}

/// The phases of all phonemes, a diphthong's two; also says how long they are together, and which
/// phonemes are unknown.
std::vector<TimedPhase> PhasesOf(const vm::PhonemeList& phonemes, const PhonemeReader& reader,
                                 const MouthSet& set, VisemeTargets& out) {
  const PhonemeShapes closed{{{static_cast<int>(set.rest), 1}}};
  std::vector<TimedPhase> phases;
  for (const vm::Phoneme& phoneme : phonemes) {
    const double length = InMs(phoneme.duration);
    const PhonemeShapes* shapes = reader.ShapesOf(phoneme.name);
    if (shapes == nullptr) {
      shapes = &closed;
      if (std::ranges::find(out.unknown, phoneme.name) == out.unknown.end()) {
        out.unknown.push_back(phoneme.name);
      }
    }
    const bool diphthong = shapes->phases.size() == 2;
    const double split = diphthong ? length * kFirstPartShare : length;
    const bool holds = length >= kLongMs;
    phases.push_back({out.length_ms, split, shapes->phases[0], holds && !diphthong});
    if (diphthong) {
      phases.push_back({out.length_ms + split, length - split, shapes->phases[1], holds});
    }
    out.length_ms += length;
  }
  ResolveNext(phases, set);
  return phases;
}

/// How many ms the shape stands before it moves on.
double HoldOf(const TimedPhase& phase, double share, bool pause) {
  if (phase.holds) return phase.length_ms - kApproachMs;
  const double hold_ms = share * phase.length_ms;
  // A contact of the lips must be seen; a pause this short need not be.
  if (share <= 0 || pause) return hold_ms;
  return std::max(hold_ms, std::min(kSeenMs, 0.85 * phase.length_ms));
}

}  // namespace

VisemeTargets MakeVisemeTargets(const vm::PhonemeList& phonemes, const MotionTables& tables,
                                const LipStyle& style) {
  const MouthSet& set = tables.mouths(style.shapes);
  const PhonemeReader reader(phonemes, set, tables.engines, style.language, style.engine);
  VisemeTargets out;
  out.rest = set.shapes[set.rest].pose;
  out.rest_dominance = set.shapes[set.rest].dominance;
  for (const TimedPhase& timed : PhasesOf(phonemes, reader, set, out)) {
    if (timed.length_ms <= 0) continue;
    const auto index = static_cast<std::size_t>(timed.phase.shape);
    const Viseme& shape = set.shapes[index];
    const bool pause = index == set.rest;
    out.targets.push_back({timed.start_ms, timed.length_ms,
                           Scaled(shape, timed.phase.strength, style),
                           HoldOf(timed, shape.hold, pause), shape.dominance, pause});
  }
  return out;
}

}  // namespace fsm
