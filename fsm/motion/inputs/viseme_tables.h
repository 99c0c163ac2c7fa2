#pragma once

#include <array>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "fsm/motion/inputs/lip_style.h"
#include "fsm/rig/face_state.h"
#include "vm_protocol/core/result.h"

namespace fsm {

/// The mouth of speech at one instant, in the units of FaceState.
struct MouthPose {
  std::array<float, kMouthParameters> mouth{};
  float seal = 0;
  float tongue = 0;
  /// How strongly the sound needs the lips in contact with each other or with the teeth, 0..1;
  /// other movements that open the mouth are reduced by that share.
  float contact = 0;
};
MouthPose Mix(const MouthPose& a, const MouthPose& b, double share_of_b);

/// The weights of a viseme's targets where sounds overlap; see tables/dominance.txt.
struct Dominance {
  double jaw = 1;
  double lips = 1;
  double round = 1;
  double tongue = 1;
  double early_ms = 40;  ///< anticipation of the rounding
  bool vowel = false;
};

/// A mouth shape of speech at full articulation.
struct Viseme {
  std::string name;
  MouthPose pose;
  double hold = 0;  ///< share of a phoneme during which its viseme is held
  Dominance dominance;
};

/// Returns the state of a face that shows only this viseme.
FaceState StateOf(const Viseme& viseme);

/// Visemes, indexed by number. Each set has one named `rest`, the mouth of pauses.
using Visemes = std::vector<Viseme>;
/// Reads the values of a viseme from the words from index `first` on: 17 parameters, then seal,
/// tongue and hold, of which the last ones may be omitted (they are then unchanged). Values:
/// finite; parameters within +-60, seal and tongue 0..1, hold 0..0.9. Error: kBadValue, and
/// `viseme` is unchanged.
vm::Result<void> ReadVisemeValues(const std::vector<std::string>& words, std::size_t first,
                                  Viseme& viseme);
/// Formats the 20 numbers as in a row of the table.
std::string FormatVisemeValues(const Viseme& viseme);
/// Reads a table of all visemes of a set, one of them `rest`. Of this reader and those below:
/// Errors: kBadValue "NAME:LINE: what was expected".
vm::Result<Visemes> ReadVisemes(const std::string& name, std::string_view text,
                                VisemeSetId set = VisemeSetId::k14);
/// Returns nullptr if there is no viseme of that name.
const Viseme* FindViseme(const Visemes& visemes, std::string_view name);

/// The visemes of a phoneme: one, or two for a diphthong.
struct PhonemeVisemes {
  static constexpr int kNext = -1;  ///< stands for the viseme of the next phoneme
  struct Phase {
    int viseme = 0;  ///< index into Visemes, or kNext
    double strength = 1;
  };
  std::vector<Phase> phases;  ///< one or two
};
/// Visemes by phoneme name; names are case-sensitive (N is not n).
using PhonemeTable = std::map<std::string, PhonemeVisemes, std::less<>>;
vm::Result<PhonemeTable> ReadPhonemeTable(const std::string& name, std::string_view text,
                                          const Visemes& visemes);

/// A set of visemes, and the phonemes of each language in it.
struct VisemeSet {
  Visemes visemes;
  PhonemeTable japanese;
  PhonemeTable english;
  std::size_t rest = 0;  ///< index of the viseme of pauses

  /// REQUIRES: `language` is not kAuto.
  const PhonemeTable& PhonemesOf(Language language) const {
    return language == Language::kEnglish ? english : japanese;
  }
};

/// How far the dominance of a sound reaches before its start and after its end.
struct DominanceReach {
  double before_ms = 40;
  double after_ms = 45;
};
/// Reads tables/dominance.txt and writes the dominances, one for each viseme, into all sets.
vm::Result<DominanceReach> ReadDominance(const std::string& name, std::string_view text,
                                         std::map<VisemeSetId, VisemeSet>& sets);

}  // namespace fsm
