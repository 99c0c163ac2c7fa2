#include "agent_manager/supervision/module_output.h"

#include <algorithm>
#include <cctype>
#include <utility>

namespace am {

OutputLine ParseOutputLine(std::string text) {
  constexpr std::size_t kLevelWithin = 80;  // bytes of a line in which its level is looked for
  std::string start = text.substr(0, kLevelWithin);
  std::ranges::transform(start, start.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  const auto says = [&](std::string_view word) {
    const std::size_t at = start.find(word);
    return at != std::string::npos &&
           (at == 0 || std::isalpha(static_cast<unsigned char>(start[at - 1])) == 0);
  };
  const std::string_view first_word = std::string_view(start).substr(0, start.find(' '));
  const bool exception = first_word.ends_with("error:") || first_word.ends_with("exception:");
  const bool error =
      exception || says("error") || says("fatal") || says("critical") || says("sanitizer");
  return {error ? "ERROR" : says("warn") ? "WARNING" : "INFO", std::move(text)};
}

}  // namespace am
