#pragma once

#include <string>
#include <unordered_map>

#include "vm_protocol/core/result.h"

namespace vdm {

/// The natural logarithm of how likely words are by themselves: the unigrams of a language model
/// of CMU Sphinx in its trie format, quantised, up to order 5 (Debian's en-us.lm.bin). Errors:
/// kUnavailable, kBadValue "FILE: ...".
vm::Result<std::unordered_map<std::string, float>> ReadWordLikelihoods(const std::string& path);

}  // namespace vdm
