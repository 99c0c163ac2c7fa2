#pragma once

#include <array>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "fsm/rig/face_state.h"
#include "vm_protocol/core/result.h"

namespace fsm {

/// What speech does to the mouth at one instant: the speech part of FaceState, same units.
struct MouthPose {
  std::array<float, kMouthParameters> mouth{};
  float seal = 0;
  float tongue = 0;
  /// How much the sound needs the lips at each other or at the teeth, 0..1: whatever else opens the
  /// mouth has to give way by so much.
  float contact = 0;
};
MouthPose Mix(const MouthPose& a, const MouthPose& b, double share_of_b);

/// How strongly a viseme insists on its targets while sounds overlap; see tables/dominance.txt.
struct Dominance {
  double jaw = 1;
  double lips = 1;
  double round = 1;
  double tongue = 1;
  double early_ms = 40;  ///< anticipation of the rounding
  bool vowel = false;
};

/// A mouth shape of speech, at full articulation.
struct Viseme {
  std::string name;
  MouthPose pose;
  double hold = 0;  ///< share of a phoneme for which the viseme stands before it moves on
  Dominance dominance;
};

/// Visemes by their numbers. Each set has one named `rest`: the mouth of pauses.
using Visemes = std::vector<Viseme>;
/// The sets there are, each called by its count: the original's, and that of the English and
/// Japanese translation system.
enum class VisemeSetId { k14 = 14, k28 = 28 };
inline constexpr std::array kVisemeSets = {VisemeSetId::k14, VisemeSetId::k28};
constexpr std::size_t CountOf(VisemeSetId set) { return static_cast<std::size_t>(set); }
/// The 17 parameters, then seal, tongue and hold, which may be left out at the end (they then stay
/// as `viseme` has them). Values: finite; parameters within +-60, seal and tongue 0..1, hold
/// 0..0.9. Error: kBadValue, and `viseme` stays as it was.
vm::Result<void> ReadVisemeValues(const std::vector<std::string>& words, std::size_t first,
                                  Viseme& viseme);
/// The 20 numbers in the form of a row of the table.
std::string FormatVisemeValues(const Viseme& viseme);
/// Reads a table of all visemes of a set, one of them `rest`. This and the readers below:
/// Errors: kBadValue "NAME:LINE: what was expected".
vm::Result<Visemes> ReadVisemes(const std::string& name, std::string_view text,
                                VisemeSetId set = VisemeSetId::k14);
/// nullptr if there is none of that name.
const Viseme* FindViseme(const Visemes& visemes, std::string_view name);

/// What a phoneme looks like: one viseme, or two for a diphthong.
struct PhonemeVisemes {
  static constexpr int kNext = -1;  ///< takes the viseme of what follows
  struct Phase {
    int viseme = 0;  ///< index into Visemes, or kNext
    double strength = 1;
  };
  std::vector<Phase> phases;  ///< one or two
};
/// By phoneme name; names differ in case (N is not n).
using PhonemeTable = std::map<std::string, PhonemeVisemes, std::less<>>;
vm::Result<PhonemeTable> ReadPhonemeTable(const std::string& name, std::string_view text,
                                          const Visemes& visemes);

/// A set of visemes and what the phonemes of each language look like in it.
struct VisemeSet {
  Visemes visemes;
  PhonemeTable japanese;
  PhonemeTable english;
  std::size_t rest = 0;  ///< index of the viseme of pauses
};

/// Dominances of the visemes of both sets, which are written into them. `reach_ms`: before and
/// after a sound's own time, see tables/dominance.txt. Every viseme must have its row.
struct Reach {
  double before_ms = 40;
  double after_ms = 45;
};
vm::Result<Reach> ReadDominance(const std::string& name, std::string_view text, Visemes& set14,
                                Visemes& set28);

}  // namespace fsm
