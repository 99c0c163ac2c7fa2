// JSGF: JSpeech Grammar Format, W3C Note 2000.

#include <algorithm>
#include <utility>

#include "ear/grammar/expansion.h"

namespace ear {
namespace {

/// JSGF without its comments; line ends stay.
std::string WithoutComments(std::string_view text) {
  std::string plain;
  for (std::size_t at = 0; at < text.size(); ++at) {
    if (text.substr(at).starts_with("//")) {
      while (at < text.size() && text[at] != '\n') ++at;
      plain += '\n';
    } else if (text.substr(at).starts_with("/*")) {
      const std::size_t end = std::min(text.find("*/", at + 2), text.size());
      for (; at < end; ++at) plain += text[at] == '\n' ? "\n" : "";
      ++at;
    } else {
      plain += text[at];
    }
  }
  return plain;
}

/// The ';' that ends a statement: none inside a tag or a quoted text.
std::size_t StatementEnd(std::string_view text, std::size_t at) {
  for (char inside = '\0'; at < text.size(); ++at) {
    const char c = text[at];
    if (inside != '\0') {
      if (c == '\\')
        ++at;
      else if (c == inside)
        inside = '\0';
    } else if (c == '{' || c == '"') {
      inside = c == '{' ? '}' : '"';
    } else if (c == ';') {
      return at;
    }
  }
  return std::string_view::npos;
}

/// "public <name> = ..." into the rules; the first public one becomes the root.
vm::Result<void> JsgfRule(std::string_view statement, std::size_t line, Grammar::Rules& rules,
                          std::string& root, std::size_t& parts) {
  const bool is_public = statement.starts_with("public") && statement.size() > 6 &&
                         (IsBlank(statement[6]) || statement[6] == '<');
  if (is_public) statement = Trim(statement.substr(6));
  const std::size_t close = statement.find('>');
  const std::size_t equal = statement.find('=');
  if (!statement.starts_with('<') || close == std::string_view::npos ||
      equal == std::string_view::npos || equal < close ||
      !Trim(statement.substr(close + 1, equal - close - 1)).empty()) {
    return Wrong(line, "found '" + std::string(statement.substr(0, 20)) +
                           "', expected grammar NAME; or [public] <NAME> = ...;");
  }
  const std::string name(Trim(statement.substr(1, close - 1)));
  auto node = ParseExpansion(statement.substr(equal + 1), Form::kJsgf, name, line, parts);
  if (!node) return std::unexpected(node.error());
  if (!rules.emplace(name, std::move(*node)).second) {
    return Wrong(line, "rule '" + name + "' is there twice");
  }
  if (is_public && root.empty()) root = name;
  return {};
}

}  // namespace

vm::Result<Grammar> ParseJsgf(std::string_view source) {
  const std::string text = WithoutComments(source);
  Grammar::Rules rules;
  std::string root;
  std::size_t line = 1, parts = 0;
  for (std::size_t at = 0; at < text.size();) {
    while (at < text.size() && IsBlank(text[at])) line += text[at++] == '\n' ? 1 : 0;
    if (at == text.size()) break;
    const std::size_t end = StatementEnd(text, at);
    if (end == std::string::npos) return Wrong(line, "expected ';' at the end of a statement");
    const std::string_view statement = std::string_view(text).substr(at, end - at);
    if (statement.starts_with("import")) return Wrong(line, "import is not supported");
    if (!statement.starts_with("#JSGF") && !statement.starts_with("grammar")) {
      if (auto taken = JsgfRule(statement, line, rules, root, parts); !taken) {
        return std::unexpected(taken.error());
      }
    }
    for (const char c : statement) line += c == '\n' ? 1 : 0;
    at = end + 1;
  }
  if (root.empty()) return Wrong(line, "there is no public rule");
  return Grammar::Make(std::move(rules), std::move(root));
}

}  // namespace ear
