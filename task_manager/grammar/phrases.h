#pragma once

#include <optional>
#include <string>

#include "task_manager/grammar/model.h"

namespace vxml::srgs {

/// A rule as the ear's slot Grammar.load takes it: words, [optional words], (one | other), `*` for
/// any word. References are written out; repeats without end go up to kMostTurns.
/// None: the rule refers to itself, has words with signs of that language, or is over `most_bytes`.
inline constexpr int kMostTurns = 10;
std::optional<std::string> ToPhrases(const Rule& rule, std::size_t most_bytes);

}  // namespace vxml::srgs
