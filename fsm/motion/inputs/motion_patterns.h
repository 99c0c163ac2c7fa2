#pragma once

#include <array>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "fsm/motion/base/face_look.h"
#include "fsm/motion/base/motion_source.h"

namespace fsm {

/// A movement of the head through key frames, from 0 0 0 at 0 ms. Keys are interpolated by a
/// monotone cubic, which does not overshoot and has slope zero at turning points (Fritsch and
/// Carlson, SIAM J. Numer. Anal. 17, 1980, with harmonic means for the slopes).
class HeadCurve {
 public:
  struct Key {
    double ms = 0;
    Angles angles{};
  };
  /// REQUIRES: times rise strictly from above 0.
  explicit HeadCurve(std::vector<Key> keys);
  Angles At(double ms) const;  ///< after the end, the angles of the last key
  double length_ms() const { return keys_.back().ms; }
  /// The keys that the constructor was given.
  std::span<const Key> keys() const { return std::span(keys_).subspan(1); }

 private:
  std::vector<Key> keys_;       // the first is 0 0 0 at 0
  std::vector<Angles> slopes_;  // degrees per millisecond
};

struct BlinkPattern {
  double closing_ms = 90;
  double shut_ms = 20;
  double opening_ms = 140;
};
/// Returns how far the lids are shut, 0..1, `since` after the start of a blink.
double LidsAt(const BlinkPattern& pattern, vm::Time since);
vm::Time LengthOf(const BlinkPattern& pattern);
struct AutoBlink {
  double interval_ms = 4000;
  std::size_t blink = 0;  ///< index of the blink pattern
  bool varied = true;     ///< half of the blinks are incomplete, as in people
};
struct AutoMove {
  double down = 0, right = 0, tilt = 0;  ///< degrees, as Angles
  double period_ms = 2500;
};
struct AutoGaze {
  double angle = 1;
  double interval_ms = 1200;
};
struct AutoBreath {
  double pitch = 0.4;
  double period_ms = 4000;
};
struct AutoNods {
  double angle = 3;
  double interval_ms = 5000;
};
struct AutoSpeech {
  double nod = 2.5;
  double turn = 2;
  double tilt = 1.5;
  double brow = 0.35;  ///< strength of AU 1 and 2
};
struct AutoAvert {
  double angle = 10;
  double shortest_ms = 1800;  ///< the eyes are averted only in utterances at least this long
};

struct AutoText {
  double size = 1;  ///< factor on the looks of text_cues.txt
};

/// The kinds of idle behaviour, each switched by name; their properties are in idle_kinds.cc.
enum class IdleKind : std::size_t {
  kBlink,
  kMove,
  kUserdef,
  kGaze,
  kBreath,
  kNods,
  kSpeech,
  kAvert,
  kFace,
  kGazeBlink,
  kEndBlink,
  kAsymmetry,
  kText
};
inline constexpr std::size_t kIdleKindCount = static_cast<std::size_t>(IdleKind::kText) + 1;
/// The pattern number of each kind; 0 = off.
using IdleProfile = std::array<std::size_t, kIdleKindCount>;

/// Returns a pattern by its number; commands and tables count from 1. REQUIRES: it exists.
template <typename T>
const T& PatternAt(const std::vector<T>& patterns, std::size_t number) {
  return patterns[number - 1];
}

/// All patterns of movement, numbered from 1 (PatternAt).
struct MotionPatterns {
  std::map<std::string, std::vector<HeadCurve>, std::less<>> head;  ///< NOD REFUSE LISTEN USERDEF
  std::vector<BlinkPattern> blinks;
  std::vector<AutoBlink> auto_blinks;
  std::vector<AutoMove> auto_moves;
  std::vector<AutoGaze> auto_gazes;
  std::vector<AutoBreath> auto_breaths;
  std::vector<AutoNods> auto_nods;
  std::vector<AutoSpeech> auto_speeches;
  std::vector<AutoAvert> auto_averts;
  std::vector<FaceLook> auto_faces;
  std::vector<AutoText> auto_texts;
  std::map<std::string, FaceLook, std::less<>> moods;  ///< by name; see MoodMotion
  std::map<std::string, IdleProfile, std::less<>> profiles;
  /// If not empty, Autonomous MOVE n loops these instead of auto_moves.
  std::vector<HeadCurve> auto_move_files;
  std::vector<HeadCurve> auto_userdef;  ///< looped by Autonomous USERDEF n
};

}  // namespace fsm
