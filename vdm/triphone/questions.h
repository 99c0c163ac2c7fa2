#pragma once

#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "vm_protocol/core/result.h"

namespace vdm {

/// A named set of phonemes: "is it one of these?" can be asked of a phoneme and of its neighbours.
struct PhonemeSet {
  std::string name;
  std::set<std::string, std::less<>> phonemes;

  bool operator==(const PhonemeSet&) const = default;
};

/// A table of sets; tables/questions.txt: a name, then phonemes. At most 256 rows. Errors:
/// kBadValue "NAME:LINE: ..." for a set without phonemes, a name that stands there twice, no or too
/// many rows.
vm::Result<std::vector<PhonemeSet>> ReadPhonemeSets(const std::string& name, std::string_view text);

}  // namespace vdm
