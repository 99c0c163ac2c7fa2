#pragma once

#include <span>
#include <string>
#include <string_view>

namespace vm {

/// Which of `known` somebody who wrote `word` may have meant: the one reached with the fewest
/// changes of a byte (at most two, and fewer than half the word), in any case; else the first one
/// that begins with it. Empty: none.
std::string_view NearestWord(std::string_view word, std::span<const std::string> known);

/// ", did you mean 'X'?" or nothing, for the end of an error's text.
std::string DidYouMean(std::string_view word, std::span<const std::string> known);

}  // namespace vm
