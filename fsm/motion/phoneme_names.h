#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "fsm/motion/viseme_tables.h"
#include "vm_protocol/core/phonemes.h"

namespace fsm {

enum class Language {
  kAuto,  ///< that of the names the list uses
  kJapanese,
  kEnglish,
};

/// One engine's names for phonemes in one language; see tables/phoneme_names.txt.
struct EngineNames {
  std::string engine;
  bool english = false;
  std::vector<std::string> endings;
  std::map<std::string, std::string, std::less<>> ours;

  /// Our name for the engine's, endings taken off if need be; "" if it has none.
  std::string_view Ours(std::string_view name) const;
};
/// Reads tables/phoneme_names.txt: every name must lead to a phoneme of `set`.
/// Errors: kBadValue "NAME:LINE: what was expected".
vm::Result<std::vector<EngineNames>> ReadPhonemeNames(const std::string& name,
                                                      std::string_view text, const VisemeSet& set);

/// The names of engines that can be asked for: FLITE and OPEN_JTALK, whose names are ours, and
/// those of the table.
std::string EngineList(const std::vector<EngineNames>& engines);

/// Finds what phonemes look like: the list of names which knows most of an utterance is used (the
/// Japanese one if several know as many), and the others help out.
class PhonemeReader {
 public:
  /// `engine` "" or AUTO = any. The set and the names outlive the reader.
  PhonemeReader(const vm::PhonemeList& phonemes, const VisemeSet& set,
                const std::vector<EngineNames>& engines, Language language,
                std::string_view engine);

  /// nullptr if no list has the name.
  const PhonemeVisemes* VisemesOf(std::string_view name) const;
  bool english() const { return english_; }

 private:
  const PhonemeVisemes* VisemesIn(const EngineNames* names, bool english,
                                  std::string_view name) const;

  const VisemeSet& set_;
  const EngineNames* names_ = nullptr;  // nullptr = our own
  bool english_ = false;
};

}  // namespace fsm
