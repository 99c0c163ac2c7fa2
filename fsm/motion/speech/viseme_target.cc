#include "fsm/motion/speech/viseme_target.h"

#include <algorithm>

#include "fsm/motion/base/easing.h"
#include "fsm/motion/inputs/motion_tables.h"
#include "fsm/motion/speech/speech_timing.h"

namespace fsm {
namespace {

constexpr double kLongMs = 200;         // phonemes at least this long hold, then move
constexpr double kClosureShare = 0.85;  // most of a phoneme that the shortest closure takes
// The share of a diphthong's first phase. With key shapes the face leaves the first one at once and
// reaches the second at the end of that share; with dominance it passes half way there.
constexpr double kFirstPartOfKeys = 0.3, kFirstPartOfDominance = 0.55;

MouthPose Scaled(const Viseme& viseme, double strength, const LipStyle& style) {
  MouthPose pose = viseme.pose;
  // A contact does not depend on the size of movements, and a weak one is still a contact, so the
  // seal is not scaled.
  const double max = pose.contact > 0 ? 1 : 3;
  for (std::size_t i = 0; i < kMouthParameters; ++i) {
    const double scale = i == kJawY || i == kJawZ ? style.jaw : style.lips;
    pose.mouth[i] = static_cast<float>(pose.mouth[i] * strength * std::clamp(scale, 0.0, max));
  }
  return pose;
}

struct TimedPhase {
  double start_ms;
  double length_ms;
  PhonemeVisemes::Phase phase;
  bool holds;
};

// "next" takes the viseme of the next phoneme, or rest at the end and before a closure of the lips.
void ResolveNext(std::vector<TimedPhase>& phases, const VisemeSet& set) {
  for (std::size_t i = phases.size(); i-- > 0;) {
    PhonemeVisemes::Phase& phase = phases[i].phase;
    if (phase.viseme != PhonemeVisemes::kNext) continue;
    const bool follows = i + 1 < phases.size();
    phase.viseme = follows ? phases[i + 1].phase.viseme : static_cast<int>(set.rest);
    const bool closes = set.visemes[static_cast<std::size_t>(phase.viseme)].pose.seal > 0;
    phase.strength *= follows && !closes ? phases[i + 1].phase.strength : 0;
  }
}

/// Returns the phases of all phonemes, two for a diphthong, whose first has the share `first_part`,
/// with their total length and the unknown phonemes.
std::vector<TimedPhase> PhasesOf(const vm::PhonemeList& phonemes, const VisemeFinder& finder,
                                 const VisemeSet& set, double first_part, VisemeTargets& out) {
  const PhonemeVisemes closed{{{static_cast<int>(set.rest), 1}}};
  std::vector<TimedPhase> phases;
  for (const vm::Phoneme& phoneme : phonemes) {
    const double length = InMs(phoneme.duration);
    const PhonemeVisemes* visemes = finder.VisemesOf(phoneme.name);
    if (visemes == nullptr) {
      visemes = &closed;
      if (std::ranges::find(out.unknown, phoneme.name) == out.unknown.end()) {
        out.unknown.push_back(phoneme.name);
      }
    }
    const bool diphthong = visemes->phases.size() == 2;
    const double split = diphthong ? length * first_part : length;
    const bool holds = length >= kLongMs;
    phases.push_back({out.length_ms, split, visemes->phases[0], holds && !diphthong});
    if (diphthong) {
      phases.push_back({out.length_ms + split, length - split, visemes->phases[1], holds});
    }
    out.length_ms += length;
  }
  ResolveNext(phases, set);
  return phases;
}

/// Returns how long a viseme is held, ms.
double HoldOf(const TimedPhase& phase, double share, bool pause) {
  if (phase.holds) return phase.length_ms - kTransitionMs;
  const double hold_ms = share * phase.length_ms;
  // A contact of the lips must be visible; a short pause need not be.
  if (share <= 0 || pause) return hold_ms;
  return std::max(hold_ms, std::min(kMinClosureMs, kClosureShare * phase.length_ms));
}

}  // namespace

VisemeTargets MakeVisemeTargets(const vm::PhonemeList& phonemes, const MotionTables& tables,
                                const LipStyle& style) {
  const VisemeSet& set = tables.set(style.visemes);
  const VisemeFinder finder(phonemes, set, tables.engines, style.language, style.engine);
  VisemeTargets out;
  out.rest = set.visemes[set.rest].pose;
  out.rest_dominance = set.visemes[set.rest].dominance;
  const double first_part =
      style.mode == LipMode::kDominance ? kFirstPartOfDominance : kFirstPartOfKeys;
  for (const TimedPhase& timed : PhasesOf(phonemes, finder, set, first_part, out)) {
    if (timed.length_ms <= 0) continue;
    const auto index = static_cast<std::size_t>(timed.phase.viseme);
    const Viseme& viseme = set.visemes[index];
    const bool pause = index == set.rest;
    out.targets.push_back({timed.start_ms, timed.length_ms,
                           Scaled(viseme, timed.phase.strength, style),
                           HoldOf(timed, viseme.hold, pause), viseme.dominance, pause});
  }
  return out;
}

}  // namespace fsm
