#include "vdm/triphone/questions.h"

#include <algorithm>
#include <sstream>

namespace vdm {
namespace {

constexpr std::size_t kMostSets = 256;

}  // namespace

vm::Result<std::vector<PhonemeSet>> ReadPhonemeSets(const std::string& name,
                                                    std::string_view text) {
  std::vector<PhonemeSet> sets;
  std::istringstream lines{std::string(text)};
  int number = 0;
  const auto wrong = [&](const std::string& what) {
    return vm::Fail(vm::Errc::kBadValue, name + ":" + std::to_string(number) + ": " + what);
  };
  for (std::string line; std::getline(lines, line);) {
    ++number;
    std::istringstream words(line);
    PhonemeSet set;
    if (!(words >> set.name) || set.name.starts_with('#')) continue;
    if (std::ranges::find(sets, set.name, &PhonemeSet::name) != sets.end()) {
      return wrong("the set '" + set.name + "' is here twice");
    }
    for (std::string phoneme; words >> phoneme;) set.phonemes.insert(phoneme);
    if (set.phonemes.empty()) return wrong("phonemes expected behind the name '" + set.name + "'");
    if (sets.size() == kMostSets) return wrong("at most 256 sets expected");
    sets.push_back(std::move(set));
  }
  if (sets.empty()) return wrong("no set found, at least one expected");
  return sets;
}

}  // namespace vdm
