// Our own form: phrases with | between, rules with $name = in front (docs/speech.md).

#include <algorithm>
#include <utility>

#include "ear/grammar/expansion.h"

namespace ear {

vm::Result<Grammar> ParseOwnForm(std::string_view text) {
  Grammar::Rules rules;
  Node main{.kind = Node::Kind::kChoice, .line = 1};
  std::size_t line = 0, parts = 0;
  while (!text.empty()) {
    ++line;
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view whole = Trim(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
    if (whole.empty() || whole.front() == '#') continue;
    std::string_view name;
    std::string_view right = whole;
    if (whole.front() == '$') {
      std::size_t stop = 1;
      while (stop < whole.size() && IsNameByte(whole[stop])) ++stop;
      const std::string_view rest = Trim(whole.substr(stop));
      if (stop > 1 && rest.starts_with('=')) {
        name = whole.substr(1, stop - 1);
        right = rest.substr(1);
      }
    }
    auto node = ParseExpansion(right, Form::kOwn, name, line, parts);
    if (!node) return std::unexpected(node.error());
    if (name.empty()) {
      main.parts.push_back(std::move(*node));
      main.weights.push_back(1);
    } else if (!rules.emplace(std::string(name), std::move(*node)).second) {
      return Wrong(line, "rule '" + std::string(name) + "' is there twice");
    }
  }
  if (main.parts.empty()) return Wrong(std::max<std::size_t>(line, 1), "there is no phrase");
  rules[""] = std::move(main);
  return Grammar::Make(std::move(rules), "");
}

}  // namespace ear
