// JSGF: JSpeech Grammar Format, W3C Note 2000.

#include <algorithm>
#include <utility>

#include "ear/grammar/expansion.h"

namespace ear {
namespace {

/// Where a tag or a quoted text that begins at `at` ends, its last sign included.
std::size_t EndOfLiteral(std::string_view text, std::size_t at) {
  const char close = text[at] == '{' ? '}' : '"';
  for (++at; at < text.size(); ++at) {
    if (text[at] == '\\') {
      ++at;
    } else if (text[at] == close) {
      return at + 1;
    }
  }
  return text.size();
}

/// JSGF without its comments; line ends stay, and so do tags and quoted texts.
std::string WithoutComments(std::string_view text) {
  std::string plain;
  for (std::size_t at = 0; at < text.size();) {
    const std::string_view rest = text.substr(at);
    std::size_t end = at + 1;
    if (rest.starts_with("//")) {
      at = end = std::min(text.find('\n', at), text.size());
    } else if (rest.starts_with("/*")) {
      end = text.find("*/", at + 2);
      end = end == text.npos ? text.size() : end + 2;
      for (; at < end; ++at) plain += text[at] == '\n' ? "\n" : "";
    } else if (rest[0] == '{' || rest[0] == '"') {
      end = EndOfLiteral(text, at);
    }
    plain += text.substr(at, end - at);
    at = end;
  }
  return plain;
}

/// The ';' that ends a statement: none inside a tag or a quoted text.
std::size_t StatementEnd(std::string_view text, std::size_t at) {
  while (at < text.size() && text[at] != ';') {
    at = text[at] == '{' || text[at] == '"' ? EndOfLiteral(text, at) : at + 1;
  }
  return at < text.size() ? at : std::string_view::npos;
}

/// A rule may be named with its grammar in front, all of its name or its last part: <t.b> is <b> in
/// the grammar "t" or "com.example.t".
void ResolveNames(Node& node, const std::string& grammar, const Grammar::Rules& rules) {
  if (node.kind == Node::Kind::kRule && !rules.contains(node.text)) {
    const std::size_t dot = node.text.rfind('.');
    const std::string front = dot == std::string::npos ? "" : node.text.substr(0, dot);
    if (!front.empty() && (grammar == front || grammar.ends_with("." + front))) {
      node.text.erase(0, dot + 1);
    }
  }
  for (Node& part : node.parts) ResolveNames(part, grammar, rules);
}

/// "grammar com.example.t" -> "com.example.t"
std::string NameIn(std::string_view statement) {
  return std::string(Trim(statement.substr(std::string_view("grammar").size())));
}

/// "public <name> = ..." into the rules, and into `open` if it is public.
vm::Result<void> JsgfRule(std::string_view statement, std::size_t line, Grammar::Rules& rules,
                          Node& open, std::size_t& parts) {
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
  if (is_public) {
    open.parts.push_back({.kind = Node::Kind::kRule, .text = name, .line = line});
    open.weights.push_back(1);
  }
  return {};
}

}  // namespace

vm::Result<Grammar> ParseJsgf(std::string_view source) {
  const std::string text = WithoutComments(source);
  Grammar::Rules rules;
  Node open{.kind = Node::Kind::kChoice, .line = 1};  // the public rules
  std::string name;
  std::size_t line = 1, parts = 0;
  for (std::size_t at = 0; at < text.size();) {
    while (at < text.size() && IsBlank(text[at])) line += text[at++] == '\n' ? 1 : 0;
    if (at == text.size()) break;
    const std::size_t end = StatementEnd(text, at);
    if (end == std::string::npos) return Wrong(line, "expected ';' at the end of a statement");
    const std::string_view statement = std::string_view(text).substr(at, end - at);
    if (statement.starts_with("import")) return Wrong(line, "import is not supported");
    if (statement.starts_with("grammar")) {
      name = NameIn(statement);
    } else if (!statement.starts_with("#JSGF")) {
      if (auto taken = JsgfRule(statement, line, rules, open, parts); !taken) {
        return std::unexpected(taken.error());
      }
    }
    for (const char c : statement) line += c == '\n' ? 1 : 0;
    at = end + 1;
  }
  if (open.parts.empty()) return Wrong(line, "there is no public rule");
  for (auto& [rule, node] : rules) ResolveNames(node, name, rules);
  std::string root = open.parts[0].text;
  if (open.parts.size() > 1) {
    root.clear();
    rules[""] = std::move(open);
  }
  return Grammar::Make(std::move(rules), std::move(root));
}

}  // namespace ear
