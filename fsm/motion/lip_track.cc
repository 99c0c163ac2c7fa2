#include "fsm/motion/lip_track.h"

#include <algorithm>
#include <array>
#include <string_view>

#include "fsm/motion/easing.h"

namespace fsm {
namespace {

constexpr double kLongMs = 200;          // from here on a phoneme holds and then moves
constexpr double kFirstPartShare = 0.3;  // of a diphthong
constexpr double kSeenMs = 34;           // just over one frame at 30 a second

// Vowels only English lists have; hh is flite's h.
constexpr std::array<std::string_view, 16> kEnglishOnly = {
    "aa", "ae", "ah", "ao", "aw", "ax", "ay", "eh", "er", "ey", "hh", "ih", "iy", "ow", "uh", "uw"};

bool LooksEnglish(const vm::PhonemeList& phonemes) {
  return std::ranges::any_of(phonemes, [](const vm::Phoneme& phoneme) {
    return std::ranges::find(kEnglishOnly, phoneme.name) != kEnglishOnly.end();
  });
}

/// A shape with its strength, in time: what one phoneme, or one half of a diphthong, asks for.
struct Demand {
  double start_ms;
  double length_ms;
  int shape;
  double strength;
  bool holds;  ///< of a phoneme of 200 ms or more: stands, and moves in the last 92 ms
};

MouthPose Scaled(const MouthShape& shape, double strength) {
  // A weak closure is still a closure, so the seal is left alone.
  MouthPose pose = shape.pose;
  for (float& value : pose.mouth) value = static_cast<float>(value * strength);
  return pose;
}

}  // namespace

LipTrack::LipTrack(const vm::PhonemeList& phonemes, const MotionTables& tables, Language language) {
  english_ =
      language == Language::kEnglish || (language == Language::kAuto && LooksEnglish(phonemes));
  // The other language's table helps out, so a mixed list still moves the lips.
  const PhonemeTable& first = english_ ? tables.phonemes_en : tables.phonemes_ja;
  const PhonemeTable& second = english_ ? tables.phonemes_ja : tables.phonemes_en;
  const PhonemeLook closed{{{0, 1}}};

  std::vector<Demand> demands;
  for (const vm::Phoneme& phoneme : phonemes) {
    const double length = InMs(phoneme.duration);
    spans_.push_back({length_ms_, phoneme.name});
    const PhonemeLook& look = [&]() -> const PhonemeLook& {
      if (const auto found = first.find(phoneme.name); found != first.end()) return found->second;
      if (const auto found = second.find(phoneme.name); found != second.end()) return found->second;
      return closed;
    }();
    const double split = look.parts.size() == 2 ? length * kFirstPartShare : length;
    const bool diphthong = look.parts.size() == 2;
    const bool holds = length >= kLongMs;
    demands.push_back(
        {length_ms_, split, look.parts[0].shape, look.parts[0].strength, holds && !diphthong});
    if (diphthong) {
      demands.push_back(
          {length_ms_ + split, length - split, look.parts[1].shape, look.parts[1].strength, holds});
    }
    length_ms_ += length;
  }

  // "next" takes over what follows; at the end, or before a closure of the lips, there is only
  // rest.
  for (std::size_t i = demands.size(); i-- > 0;) {
    if (demands[i].shape != PhonemeLook::kNext) continue;
    const bool follows = i + 1 < demands.size();
    const int shape = follows ? demands[i + 1].shape : 0;
    const bool closes = tables.shapes[static_cast<std::size_t>(shape)].pose.seal > 0;
    demands[i].shape = shape;
    demands[i].strength *= follows && !closes ? demands[i + 1].strength : 0;
  }

  const MouthPose rest = tables.shapes[0].pose;
  keys_.push_back({-kApproachMs, rest});
  for (const Demand& demand : demands) {
    if (demand.length_ms <= 0) continue;
    const MouthShape& shape = tables.shapes[static_cast<std::size_t>(demand.shape)];
    const MouthPose pose = Scaled(shape, demand.strength);
    keys_.push_back({demand.start_ms, pose});
    double hold = 0;
    if (demand.holds) {
      hold = demand.length_ms - kApproachMs;
    } else if (shape.hold > 0) {
      hold = shape.hold * demand.length_ms;
      // A closure of the lips must be seen; a pause this short need not be.
      if (demand.shape != 0) hold = std::max(hold, std::min(kSeenMs, 0.85 * demand.length_ms));
    }
    if (hold > 0) keys_.push_back({demand.start_ms + hold, pose});
  }
  keys_.push_back({length_ms_, rest});
}

MouthPose LipTrack::At(double position_ms) const {
  if (position_ms <= keys_.front().ms) return keys_.front().pose;
  if (position_ms >= keys_.back().ms) return keys_.back().pose;
  const auto next = std::ranges::upper_bound(keys_, position_ms, {}, &Key::ms);
  const Key& a = *(next - 1);
  return Mix(a.pose, next->pose, Sinusoid((position_ms - a.ms) / (next->ms - a.ms)));
}

const std::string& LipTrack::PhonemeAt(double position_ms) const {
  static const std::string kNone;
  if (position_ms < 0 || position_ms >= length_ms_) return kNone;
  return std::prev(std::ranges::upper_bound(spans_, position_ms, {}, &Span::start_ms))->name;
}

}  // namespace fsm
