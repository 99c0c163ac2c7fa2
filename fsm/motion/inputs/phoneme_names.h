#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "fsm/motion/inputs/viseme_tables.h"
#include "vm_protocol/core/phonemes.h"

namespace fsm {

/// The phoneme names of a speech engine in one language; see tables/phoneme_names.txt.
struct EngineNames {
  std::string engine;
  Language language = Language::kJapanese;
  std::vector<std::string> endings;
  std::map<std::string, std::string, std::less<>> ours;

  /// Returns our name for an engine's phoneme, removing `endings` if necessary; "" if unknown.
  std::string_view Ours(std::string_view name) const;
};
/// Reads tables/phoneme_names.txt: every name must map to a phoneme of `set`.
/// Errors: kBadValue "NAME:LINE: what was expected".
vm::Result<std::vector<EngineNames>> ReadPhonemeNames(const std::string& name,
                                                      std::string_view text, const VisemeSet& set);

/// Returns the engine names that VisemeFinder accepts: FLITE and OPEN_JTALK, whose phoneme names
/// are ours, and those of the table.
std::string EngineList(const std::vector<EngineNames>& engines);

/// Finds the visemes of phonemes. Uses the list of names that knows most phonemes of an utterance
/// (the Japanese one if several know equally many), and the others for names it lacks.
class VisemeFinder {
 public:
  /// `engine`: "" or AUTO = any. Lifetime: `set` and `engines` outlive the finder.
  VisemeFinder(const vm::PhonemeList& phonemes, const VisemeSet& set,
               const std::vector<EngineNames>& engines, Language language, std::string_view engine);

  /// Returns nullptr if no list has the name.
  const PhonemeVisemes* VisemesOf(std::string_view name) const;
  Language language() const { return language_; }

 private:
  const PhonemeVisemes* VisemesIn(const EngineNames* names, Language language,
                                  std::string_view name) const;

  const VisemeSet& set_;
  const EngineNames* names_ = nullptr;  // nullptr = our own
  Language language_ = Language::kJapanese;
};

}  // namespace fsm
