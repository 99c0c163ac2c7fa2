#include "vdm/triphone/questions.h"

#include <algorithm>

#include "vdm/net/word_lines.h"

namespace vdm {

vm::Result<std::vector<PhonemeSet>> ReadPhonemeSets(const std::string& name,
                                                    std::string_view text) {
  constexpr std::size_t kMostSets = 256;
  std::vector<PhonemeSet> sets;
  WordLines lines(name, text);
  for (auto words = lines.Next(); !words.empty(); words = lines.Next()) {
    PhonemeSet set{std::string(words[0]), {words.begin() + 1, words.end()}};
    if (std::ranges::find(sets, set.name, &PhonemeSet::name) != sets.end()) {
      return lines.Wrong("the set '" + set.name + "' is here twice");
    }
    if (set.phonemes.empty()) {
      return lines.Wrong("phonemes expected behind the name '" + set.name + "'");
    }
    if (sets.size() == kMostSets) return lines.Wrong("at most 256 sets expected");
    sets.push_back(std::move(set));
  }
  if (sets.empty()) return lines.Wrong("no set found, at least one expected");
  return sets;
}

}  // namespace vdm
