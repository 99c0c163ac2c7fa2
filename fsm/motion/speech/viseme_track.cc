#include "fsm/motion/speech/viseme_track.h"

#include <algorithm>

#include "fsm/motion/base/easing.h"
#include "fsm/motion/inputs/motion_tables.h"
#include "fsm/motion/speech/speech_timing.h"

namespace fsm {

VisemeTrack::VisemeTrack(const vm::PhonemeList& phonemes, const MotionTables& tables,
                         const LipStyle& style)
    : mode_(style.mode), targets_(MakeVisemeTargets(phonemes, tables, style)) {
  double start = 0;
  for (const vm::Phoneme& phoneme : phonemes) {
    spans_.push_back({start, phoneme.name});
    start += InMs(phoneme.duration);
  }
  if (mode_ == LipMode::kDominance) {
    curves_.emplace(targets_, tables.reach, tables.gestures);
  } else {
    MakeKeys();
  }
}

void VisemeTrack::MakeKeys() {
  keys_.push_back({-kTransitionMs, targets_.rest});
  for (const VisemeTarget& target : targets_.targets) {
    keys_.push_back({target.start_ms, target.pose});
    if (target.hold_ms > 0) keys_.push_back({target.start_ms + target.hold_ms, target.pose});
  }
  keys_.push_back({targets_.length_ms, targets_.rest});
}

MouthPose VisemeTrack::At(double position_ms) const {
  if (curves_) return curves_->At(position_ms);
  if (position_ms <= keys_.front().ms) return keys_.front().pose;
  if (position_ms >= keys_.back().ms) return keys_.back().pose;
  const auto next = std::ranges::upper_bound(keys_, position_ms, {}, &Key::ms);
  const Key& a = *(next - 1);
  const double u = (position_ms - a.ms) / (next->ms - a.ms);
  return Mix(a.pose, next->pose, mode_ == LipMode::kLinear ? u : CosineStep(u));
}

const std::string& VisemeTrack::PhonemeAt(double position_ms) const {
  static const std::string kNone;
  if (position_ms < 0 || position_ms >= length_ms()) return kNone;
  return std::prev(std::ranges::upper_bound(spans_, position_ms, {}, &Span::start_ms))->name;
}

}  // namespace fsm
