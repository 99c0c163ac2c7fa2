#include "ear/grammar/expansion.h"

#include <charconv>
#include <cstdlib>
#include <utility>

#include "ear/grammar/grammar_limits.h"

namespace ear {
namespace {

using Kind = Node::Kind;

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
  Expansion(std::string_view text, Form form, std::string_view rule, std::size_t line,
            std::size_t& parts)
      : text_(text), form_(form), rule_(rule), line_(line), parts_(parts) {}

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

  std::unexpected<vm::Error> TooMuch(const std::string& what) const {
    return vm::Fail(vm::Errc::kLimit, AtLine(line_) + RuleLabel(rule_) + ": " + what);
  }

  char Peek() {
    while (at_ < text_.size() && IsBlank(text_[at_])) {
      if (text_[at_] == '\n') ++line_;
      ++at_;
    }
    return at_ < text_.size() ? text_[at_] : '\0';
  }

  vm::Result<Node> Choice(int depth) {
    if (depth > kMaxNesting) return TooMuch(NestedTooDeep());
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
      // What never is said is as if it were not there (JSGF, weights).
      if (weight == 0) *sequence = Node{.kind = Kind::kVoid, .line = line_};
      choice.parts.push_back(std::move(*sequence));
      choice.weights.push_back(weight == 0 ? 1 : weight);
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
    if (number.empty() || *rest != '\0' || !(weight >= 0) || weight > 1e6) {
      return Expected("/NUMBER/ of 0 or more");
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
      if (++parts_ > kMaxParts) return TooMuch(TooManyParts());
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
    if (name == "GARBAGE") return GarbageNode(line_);
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
  const std::string_view rule_;
  std::size_t line_;
  std::size_t& parts_;
  std::size_t at_ = 0;
};

}  // namespace

vm::Result<Node> ParseExpansion(std::string_view text, Form form, std::string_view rule,
                                std::size_t line, std::size_t& parts) {
  return Expansion(text, form, rule, line, parts).Whole();
}

Node GarbageNode(std::size_t line) {
  Node garbage{.kind = Kind::kRepeat, .least = 0, .most = 1, .line = line};
  garbage.parts.push_back({.kind = Kind::kAny, .line = line});
  return garbage;
}

std::string AtLine(std::size_t line) {
  return line == 0 ? std::string() : "line " + std::to_string(line) + ": ";
}
std::string RuleLabel(std::string_view rule) {
  return rule.empty() ? "the phrases" : "rule '" + std::string(rule) + "'";
}
std::string NestedTooDeep() { return "nested deeper than " + std::to_string(kMaxNesting); }
std::string TooManyParts() {
  return "the grammar has more than " + std::to_string(kMaxParts) + " parts";
}

bool IsBlank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }
bool IsNameByte(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
         c == '-' || c == '.' || static_cast<unsigned char>(c) >= 0x80;
}

std::string_view Trim(std::string_view text) {
  while (!text.empty() && IsBlank(text.front())) text.remove_prefix(1);
  while (!text.empty() && IsBlank(text.back())) text.remove_suffix(1);
  return text;
}

std::unexpected<vm::Error> Wrong(std::size_t line, const std::string& what) {
  return vm::Fail(vm::Errc::kSyntax, "line " + std::to_string(line) + ": " + what);
}

}  // namespace ear
