// The two forms of grammar written as text: our own and JSGF (JSpeech Grammar Format, W3C Note
// 2000). They differ in how rules are named and in what * means.

#include <charconv>
#include <cstdlib>
#include <utility>

#include "srm/grammar/grammar.h"

namespace srm {
namespace {

using Kind = Node::Kind;

enum class Form { kOwn, kJsgf };

bool IsBlank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }
bool IsNameByte(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
         c == '-' || c == '.' || static_cast<unsigned char>(c) >= 0x80;
}

Node WordsNode(std::string_view text, std::size_t line) {
  Node sequence{.line = line};
  for (std::string& word : WordsOf(text)) {
    sequence.parts.push_back({.kind = Kind::kWord, .text = std::move(word), .line = line});
  }
  return sequence.parts.size() == 1 ? std::move(sequence.parts[0]) : sequence;
}

/// What stands right of a rule's name.
class Expansion {
 public:
  Expansion(std::string_view text, Form form, std::size_t line)
      : text_(text), form_(form), line_(line) {}

  vm::Result<Node> Whole() {
    auto node = Choice(0);
    if (node && Peek() != '\0') return Expected("'|' or the end");
    return node;
  }

 private:
  std::unexpected<vm::Error> Expected(const std::string& what) {
    const char c = Peek();
    const std::string found =
        c == '\0' ? "the end" : "'" + std::string(text_.substr(at_, 12)) + "'";
    return vm::Fail(vm::Errc::kSyntax,
                    "line " + std::to_string(line_) + ": found " + found + ", expected " + what);
  }

  char Peek() {
    while (at_ < text_.size() && IsBlank(text_[at_])) {
      if (text_[at_] == '\n') ++line_;
      ++at_;
    }
    return at_ < text_.size() ? text_[at_] : '\0';
  }

  vm::Result<Node> Choice(int depth) {
    if (depth > Grammar::kMaxDepth) return vm::Fail(vm::Errc::kLimit, "nested too deep");
    Node choice{.kind = Kind::kChoice, .line = line_};
    while (true) {
      double weight = 1;
      if (Peek() == '/') {
        auto read = Weight();
        if (!read) return std::unexpected(read.error());
        weight = *read;
      }
      auto sequence = Sequence(depth);
      if (!sequence) return sequence;
      choice.parts.push_back(std::move(*sequence));
      choice.weights.push_back(weight);
      if (Peek() != '|') break;
      ++at_;
    }
    if (choice.parts.size() == 1) return Node(std::move(choice.parts[0]));
    return choice;
  }

  vm::Result<double> Weight() {
    const std::size_t end = text_.find('/', at_ + 1);
    if (end == std::string_view::npos) return Expected("'/' after a weight");
    const std::string number(text_.substr(at_ + 1, end - at_ - 1));
    char* rest = nullptr;
    const double weight = std::strtod(number.c_str(), &rest);
    if (number.empty() || *rest != '\0' || !(weight > 0) || weight > 1e6) {
      return Expected("/NUMBER/ above 0");
    }
    at_ = end + 1;
    return weight;
  }

  vm::Result<Node> Sequence(int depth) {
    Node sequence{.line = line_};
    bool words = false;
    while (true) {
      const char c = Peek();
      if (c == '\0' || c == '|' || c == ')' || c == ']') break;
      auto item = Item(c, depth);
      if (!item) return item;
      words = words || item->kind != Kind::kTag;
      if (auto repeated = Repeated(std::move(*item)); repeated) {
        sequence.parts.push_back(std::move(*repeated));
      } else {
        return repeated;
      }
    }
    if (!words) return Expected("a word");
    return sequence;
  }

  vm::Result<Node> Item(char c, int depth) {
    if (c == '(' || c == '[') return Group(depth + 1, c == '[' ? ']' : ')');
    if (c == '{') return Tag();
    if (c == '"') return Quoted();
    if (form_ == Form::kOwn && c == '*') {
      ++at_;
      return Node{.kind = Kind::kAny, .line = line_};
    }
    if ((form_ == Form::kOwn && c == '$') || (form_ == Form::kJsgf && c == '<')) return Rule();
    const std::size_t begin = at_;
    while (at_ < text_.size() && !IsBlank(text_[at_]) &&
           std::string_view("|{}[]()*+<>/;=\"$").find(text_[at_]) == std::string_view::npos) {
      ++at_;
    }
    if (at_ == begin) return Expected("a word");
    return WordsNode(text_.substr(begin, at_ - begin), line_);
  }

  vm::Result<Node> Group(int depth, char close) {
    ++at_;
    auto inner = Choice(depth);
    if (!inner) return inner;
    if (Peek() != close) return Expected("'|' or '" + std::string(1, close) + "'");
    ++at_;
    if (close == ')') return inner;
    Node optional{.kind = Kind::kRepeat, .least = 0, .most = 1, .line = line_};
    optional.parts.push_back(std::move(*inner));
    return optional;
  }

  vm::Result<Node> Tag() {
    std::string tag;
    for (++at_; at_ < text_.size() && text_[at_] != '}'; ++at_) {
      if (text_[at_] == '\\' && at_ + 1 < text_.size()) ++at_;
      tag += text_[at_];
    }
    if (at_ == text_.size()) return Expected("'}'");
    ++at_;
    return Node{.kind = Kind::kTag, .text = std::move(tag), .line = line_};
  }

  vm::Result<Node> Quoted() {
    const std::size_t end = text_.find('"', at_ + 1);
    if (end == std::string_view::npos) return Expected("'\"'");
    Node words = WordsNode(text_.substr(at_ + 1, end - at_ - 1), line_);
    at_ = end + 1;
    return words;
  }

  vm::Result<Node> Rule() {
    const std::size_t begin = ++at_;
    while (at_ < text_.size() && IsNameByte(text_[at_])) ++at_;
    std::string name(text_.substr(begin, at_ - begin));
    if (name.empty()) return Expected("a rule's name");
    if (form_ == Form::kJsgf) {
      if (Peek() != '>') return Expected("'>'");
      ++at_;
    }
    if (name == "NULL") return Node{.line = line_};
    if (name == "VOID") return Node{.kind = Kind::kVoid, .line = line_};
    if (name == "GARBAGE") return Node{.kind = Kind::kAny, .line = line_};
    return Node{.kind = Kind::kRule, .text = std::move(name), .line = line_};
  }

  /// + behind an item, in JSGF also *, in our form <2> or <2-4> or <2->.
  vm::Result<Node> Repeated(Node item) {
    Node repeat{.kind = Kind::kRepeat, .line = line_};
    const char c = at_ < text_.size() ? text_[at_] : '\0';
    if (c == '+' || (c == '*' && form_ == Form::kJsgf)) {
      ++at_;
      repeat.least = c == '+' ? 1 : 0;
      repeat.most = kUnlimited;
    } else if (c == '<' && form_ == Form::kOwn) {
      const std::size_t end = text_.find('>', at_);
      if (end == std::string_view::npos || !Range(text_.substr(at_ + 1, end - at_ - 1), repeat)) {
        return Expected("<N>, <N-M> or <N->");
      }
      at_ = end + 1;
    } else {
      return item;
    }
    repeat.parts.push_back(std::move(item));
    return repeat;
  }

  static bool Range(std::string_view text, Node& repeat) {
    const char* end = text.data() + text.size();
    auto [rest, error] = std::from_chars(text.data(), end, repeat.least);
    if (error != std::errc()) return false;
    repeat.most = repeat.least;
    if (rest == end) return true;
    if (*rest++ != '-') return false;
    repeat.most = kUnlimited;
    if (rest == end) return true;
    const auto [last, wrong] = std::from_chars(rest, end, repeat.most);
    return wrong == std::errc() && last == end;
  }

  std::string_view text_;
  const Form form_;
  std::size_t line_;
  std::size_t at_ = 0;
};

std::string_view Trim(std::string_view text) {
  while (!text.empty() && IsBlank(text.front())) text.remove_prefix(1);
  while (!text.empty() && IsBlank(text.back())) text.remove_suffix(1);
  return text;
}

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

std::unexpected<vm::Error> Wrong(std::size_t line, const std::string& what) {
  return vm::Fail(vm::Errc::kSyntax, "line " + std::to_string(line) + ": " + what);
}

/// "public <name> = ..." into the rules; the first public one becomes the root.
vm::Result<void> JsgfRule(std::string_view statement, std::size_t line, Grammar::Rules& rules,
                          std::string& root) {
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
  auto node = Expansion(statement.substr(equal + 1), Form::kJsgf, line).Whole();
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
  std::size_t line = 1;
  for (std::size_t at = 0; at < text.size();) {
    while (at < text.size() && IsBlank(text[at])) line += text[at++] == '\n' ? 1 : 0;
    if (at == text.size()) break;
    const std::size_t end = StatementEnd(text, at);
    if (end == std::string::npos) return Wrong(line, "expected ';' at the end of a statement");
    const std::string_view statement = std::string_view(text).substr(at, end - at);
    if (statement.starts_with("import")) return Wrong(line, "import is not supported");
    if (!statement.starts_with("#JSGF") && !statement.starts_with("grammar")) {
      if (auto taken = JsgfRule(statement, line, rules, root); !taken) {
        return std::unexpected(taken.error());
      }
    }
    for (const char c : statement) line += c == '\n' ? 1 : 0;
    at = end + 1;
  }
  if (root.empty()) return Wrong(line, "there is no public rule");
  return Grammar::Make(std::move(rules), std::move(root));
}

vm::Result<Grammar> ParseOwnForm(std::string_view text) {
  Grammar::Rules rules;
  Node main{.kind = Kind::kChoice, .line = 1};
  std::size_t line = 0;
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
      if (rest.starts_with('=')) {
        name = whole.substr(1, stop - 1);
        right = rest.substr(1);
      }
    }
    auto node = Expansion(right, Form::kOwn, line).Whole();
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

}  // namespace srm
