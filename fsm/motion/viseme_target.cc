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

struct Part {
  double start_ms;
  double length_ms;
  PhonemeLook::Part look;
  bool holds;
};

// "next" takes over what follows; at the end, or before a closure of the lips, there is only rest.
void ResolveNext(std::vector<Part>& parts, const MouthSet& set) {
  for (std::size_t i = parts.size(); i-- > 0;) {
    PhonemeLook::Part& look = parts[i].look;
    if (look.shape != PhonemeLook::kNext) continue;
    const bool follows = i + 1 < parts.size();
    look.shape = follows ? parts[i + 1].look.shape : static_cast<int>(set.rest);
    const bool closes = set.shapes[static_cast<std::size_t>(look.shape)].pose.seal > 0;
    look.strength *= follows && !closes ? parts[i + 1].look.strength : 0;
  }
}

/// The parts of all phonemes, a diphthong's two; also says how long they are together, and which
/// phonemes are unknown.
std::vector<Part> PartsOf(const vm::PhonemeList& phonemes, const PhonemeReader& reader,
                          const MouthSet& set, VisemeTargets& out) {
  const PhonemeLook closed{{{static_cast<int>(set.rest), 1}}};
  std::vector<Part> parts;
  for (const vm::Phoneme& phoneme : phonemes) {
    const double length = InMs(phoneme.duration);
    const PhonemeLook* look = reader.Look(phoneme.name);
    if (look == nullptr) {
      look = &closed;
      if (std::ranges::find(out.unknown, phoneme.name) == out.unknown.end()) {
        out.unknown.push_back(phoneme.name);
      }
    }
    const bool diphthong = look->parts.size() == 2;
    const double split = diphthong ? length * kFirstPartShare : length;
    const bool holds = length >= kLongMs;
    parts.push_back({out.length_ms, split, look->parts[0], holds && !diphthong});
    if (diphthong) {
      parts.push_back({out.length_ms + split, length - split, look->parts[1], holds});
    }
    out.length_ms += length;
  }
  ResolveNext(parts, set);
  return parts;
}

/// For how many ms the shape stands before it moves on.
double HoldOf(const Part& part, double share, bool pause) {
  if (part.holds) return part.length_ms - kApproachMs;
  const double hold_ms = share * part.length_ms;
  // A contact of the lips must be seen; a pause this short need not be.
  if (share <= 0 || pause) return hold_ms;
  return std::max(hold_ms, std::min(kSeenMs, 0.85 * part.length_ms));
}

}  // namespace

VisemeTargets MakeVisemeTargets(const vm::PhonemeList& phonemes, const MotionTables& tables,
                                const LipStyle& style) {
  const MouthSet& set = style.bilingual ? tables.set28 : tables.set14;
  const PhonemeReader reader(phonemes, set, tables.engines, style.language, style.engine);
  VisemeTargets out;
  out.english = reader.english();
  out.rest = set.shapes[set.rest].pose;
  for (const Part& part : PartsOf(phonemes, reader, set, out)) {
    if (part.length_ms <= 0) continue;
    const auto index = static_cast<std::size_t>(part.look.shape);
    const Viseme& shape = set.shapes[index];
    const bool pause = index == set.rest;
    out.targets.push_back({part.start_ms, part.length_ms, Scaled(shape, part.look.strength, style),
                           HoldOf(part, shape.hold, pause), shape.dominance, pause, part.holds});
  }
  return out;
}

}  // namespace fsm
