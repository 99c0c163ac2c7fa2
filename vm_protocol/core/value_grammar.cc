#include "vm_protocol/core/value_grammar.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <iterator>
#include <optional>
#include <stdexcept>
#include <utility>

#include "vm_protocol/core/blanks.h"
#include "vm_protocol/core/lower_case.h"
#include "vm_protocol/core/nearest_word.h"
#include "vm_protocol/core/start_time.h"
#include "vm_protocol/core/utf8.h"

namespace vm {

/// One element of a grammar. A tree; small, made once at start.
struct ValueGrammar::Node {
  enum class Kind {
    kSequence,
    kAlternatives,
    kOptional,
    kRepeat,
    kLiteral,
    kNumber,
    kInt,
    kMs,
    kTime,
    kWord,
    kText,
    kMarkup,
    kFile
  };
  Kind kind = Kind::kSequence;
  std::string literal;
  double low = -1e12;
  double high = 1e12;
  std::vector<std::unique_ptr<Node>> children;
};

namespace {

std::size_t SkipBlanks(std::string_view text, std::size_t at) {
  while (at < text.size() && IsBlank(text[at])) ++at;
  return at;
}

std::size_t WordEnd(std::string_view text, std::size_t at) {
  while (at < text.size() && !IsBlank(text[at])) ++at;
  return at;
}

std::optional<double> ReadNumber(std::string_view word) {
  if (word.empty() || word.find_first_not_of("0123456789.eE+-") != std::string_view::npos) {
    return std::nullopt;
  }
  const std::string copy(word);
  char* end = nullptr;
  const double value = std::strtod(copy.c_str(), &end);
  if (end != copy.c_str() + copy.size() || !std::isfinite(value) || std::fabs(value) > 1e12) {
    return std::nullopt;
  }
  return value;
}

std::optional<unsigned> ReadHex4(std::string_view text, std::size_t at) {
  if (at + 4 > text.size()) return std::nullopt;
  unsigned value = 0;
  for (std::size_t i = at; i < at + 4; ++i) {
    const char c = text[i];
    unsigned digit = 0;
    if (c >= '0' && c <= '9') {
      digit = static_cast<unsigned>(c - '0');
    } else if (c >= 'a' && c <= 'f') {
      digit = static_cast<unsigned>(c - 'a' + 10);
    } else if (c >= 'A' && c <= 'F') {
      digit = static_cast<unsigned>(c - 'A' + 10);
    } else {
      return std::nullopt;
    }
    value = value * 16 + digit;
  }
  return value;
}

/// Reads a "quoted string" with JSON escapes at `at`; gives its content and the place behind it.
std::optional<std::pair<std::string, std::size_t>> ReadQuoted(std::string_view text,
                                                              std::size_t at) {
  std::string content;
  std::size_t i = at + 1;
  while (i < text.size()) {
    const char c = text[i];
    if (c == '"') return std::pair(std::move(content), i + 1);
    if (c != '\\') {
      content += c;
      ++i;
      continue;
    }
    if (i + 1 >= text.size()) return std::nullopt;
    const char escape = text[i + 1];
    constexpr std::string_view kFrom = "\"\\/bfnrt";
    constexpr std::string_view kTo = "\"\\/\b\f\n\r\t";
    if (const auto which = kFrom.find(escape); which != std::string_view::npos) {
      content += kTo[which];
      i += 2;
      continue;
    }
    if (escape != 'u') return std::nullopt;
    auto code = ReadHex4(text, i + 2);
    if (!code) return std::nullopt;
    i += 6;
    if (*code >= 0xD800 && *code <= 0xDBFF) {  // the first half of a surrogate pair
      if (i + 1 >= text.size() || text[i] != '\\' || text[i + 1] != 'u') return std::nullopt;
      const auto second = ReadHex4(text, i + 2);
      if (!second || *second < 0xDC00 || *second > 0xDFFF) return std::nullopt;
      code = 0x10000 + ((*code - 0xD800) << 10) + (*second - 0xDC00);
      i += 6;
    } else if (*code >= 0xDC00 && *code <= 0xDFFF) {
      return std::nullopt;
    }
    AppendUtf8(content, *code);
  }
  return std::nullopt;
}

/// A text without the signs of private use (U+E000 to U+F8FF), which readers may take out.
std::string WithoutPrivateUse(std::string_view text) {
  std::string kept;
  kept.reserve(text.size());
  for (std::size_t at = 0; at < text.size();) {
    const CodePoint sign = SignAt(text, at);
    if (sign.value < 0xE000 || sign.value > 0xF8FF) kept += text.substr(at, sign.length);
    at += sign.length;
  }
  return kept;
}

/// Puts in what the five references of XML stand for.
void ReplaceReferences(std::string& name) {
  constexpr std::pair<std::string_view, char> kReferences[] = {
      {"&lt;", '<'}, {"&gt;", '>'}, {"&quot;", '"'}, {"&apos;", '\''}, {"&amp;", '&'}};
  for (std::size_t at = name.find('&'); at != std::string::npos; at = name.find('&', at + 1)) {
    const auto known = std::ranges::find_if(kReferences, [&](const auto& reference) {
      return std::string_view(name).substr(at).starts_with(reference.first);
    });
    // Of a number, say: only a reader of XML knows, so it is given as what is no plain path.
    if (known == std::end(kReferences)) {
      name.insert(0, "markup:");
      return;
    }
    name.replace(at, known->first.size(), 1, known->second);
  }
}

/// What the src attributes in a text name, without reading it as XML: more may be found than are
/// there, never fewer.
std::vector<std::string> SourcesIn(std::string_view text) {
  const std::string markup = WithoutPrivateUse(text);
  constexpr std::string_view kBlanks = " \t\r\n\v\f";
  constexpr std::string_view kAttribute = "src";
  std::vector<std::string> names;
  for (std::size_t at = markup.find(kAttribute); at != std::string::npos;
       at = markup.find(kAttribute, at + 1)) {
    const std::size_t sign = markup.find_first_not_of(kBlanks, at + kAttribute.size());
    if (sign == std::string_view::npos || markup[sign] != '=') continue;
    const std::size_t quote = markup.find_first_not_of(kBlanks, sign + 1);
    if (quote == std::string_view::npos || (markup[quote] != '"' && markup[quote] != '\''))
      continue;
    const std::size_t end = markup.find(markup[quote], quote + 1);
    if (end == std::string_view::npos) continue;
    std::string name = markup.substr(quote + 1, end - quote - 1);
    ReplaceReferences(name);
    if (!name.empty()) names.push_back(std::move(name));
  }
  return names;
}

}  // namespace

namespace {

/// A fault in a grammar's text.
struct GrammarFault {
  std::size_t at;
  std::string expected;
};

/// Reads the grammar text itself. Throws GrammarFault, which Parse catches.
template <typename Node>
class GrammarReader {
 public:
  explicit GrammarReader(std::string_view text) : text_(text) {}

  std::unique_ptr<Node> Read() {
    auto root = Alternatives();
    if (at_ != text_.size()) throw GrammarFault{at_, "the end of the grammar"};
    return root;
  }

 private:
  using NodeKind = typename Node::Kind;
  using NodePtr = std::unique_ptr<Node>;

  static NodePtr Make(NodeKind kind) {
    auto node = std::make_unique<Node>();
    node->kind = kind;
    return node;
  }
  void Skip() { at_ = SkipBlanks(text_, at_); }
  char Peek() {
    Skip();
    return at_ < text_.size() ? text_[at_] : '\0';
  }
  void Expect(char c) {
    if (Peek() != c) throw GrammarFault{at_, std::string("'") + c + "'"};
    ++at_;
  }

  NodePtr Alternatives() {
    auto node = Make(NodeKind::kAlternatives);
    node->children.push_back(Sequence());
    while (Peek() == '|') {
      ++at_;
      node->children.push_back(Sequence());
    }
    return node->children.size() == 1 ? std::move(node->children.front()) : std::move(node);
  }

  NodePtr Sequence() {
    auto node = Make(NodeKind::kSequence);
    for (char c = Peek(); c != '\0' && c != '|' && c != ')' && c != ']'; c = Peek()) {
      NodePtr term = Term();
      if (text_.substr(at_).starts_with("...")) {
        at_ += 3;
        auto repeat = Make(NodeKind::kRepeat);
        repeat->children.push_back(std::move(term));
        term = std::move(repeat);
      }
      node->children.push_back(std::move(term));
    }
    if (node->children.empty()) throw GrammarFault{at_, "a word, a placeholder or a bracket"};
    return node;
  }

  NodePtr Term() {
    const char c = Peek();
    if (c == '[' || c == '(') {
      if (++depth_ > ValueGrammar::kMaxDepth)
        throw GrammarFault{
            at_, "at most " + std::to_string(ValueGrammar::kMaxDepth) + " brackets in each other"};
      ++at_;
      NodePtr inner = Alternatives();
      Expect(c == '[' ? ']' : ')');
      --depth_;
      if (c == '(') return inner;
      auto optional = Make(NodeKind::kOptional);
      optional->children.push_back(std::move(inner));
      return optional;
    }
    if (c == '<') return Placeholder();
    auto literal = Make(NodeKind::kLiteral);
    const std::size_t end = std::min(text_.find_first_of(" \t|()[]<", at_), text_.size());
    std::string_view word = text_.substr(at_, end - at_);
    if (word.size() > 3 && word.ends_with("...")) word.remove_suffix(3);
    literal->literal = word;
    at_ += word.size();
    return literal;
  }

  NodePtr Placeholder() {
    const std::size_t end = text_.find('>', at_);
    if (end == std::string_view::npos) throw GrammarFault{at_, "'>'"};
    const std::size_t start = at_;
    const std::string_view inside = text_.substr(at_ + 1, end - at_ - 1);
    at_ = end + 1;
    const std::size_t blank = inside.find(' ');
    const std::string_view name = inside.substr(0, blank);
    static constexpr std::pair<std::string_view, NodeKind> kKinds[] = {
        {"number", NodeKind::kNumber}, {"int", NodeKind::kInt},   {"ms", NodeKind::kMs},
        {"time", NodeKind::kTime},     {"word", NodeKind::kWord}, {"text", NodeKind::kText},
        {"markup", NodeKind::kMarkup}, {"file", NodeKind::kFile}};
    for (const auto& [word, kind] : kKinds) {
      if (word != name) continue;
      auto node = Make(kind);
      if (kind == NodeKind::kMs) {
        node->low = 0;
        node->high = 86'400'000;
      }
      if (blank != std::string_view::npos) ReadRange(inside.substr(blank + 1), *node, start);
      return node;
    }
    throw GrammarFault{start, "<number>, <int>, <ms>, <time>, <word>, <text>, <markup> or <file>"};
  }

  static void ReadRange(std::string_view range, Node& node, std::size_t at) {
    const std::size_t dots = range.find("..");
    const auto bound = [&](std::string_view text, double& target) {
      if (text.empty()) return;
      const auto number = ReadNumber(text);
      if (!number) throw GrammarFault{at, "a range of numbers, LOW..HIGH"};
      target = *number;
    };
    if (dots == std::string_view::npos) throw GrammarFault{at, "a range, LOW..HIGH"};
    bound(range.substr(0, dots), node.low);
    bound(range.substr(dots + 2), node.high);
  }

  std::string_view text_;
  std::size_t at_ = 0;
  std::size_t depth_ = 0;
};

/// Matches by continuation: an element calls `next` with the place behind it, and tries its next
/// possibility if that fails. Remembers the farthest place reached, for the error.
template <typename Node>
class Matcher {
 public:
  using Items = ValueGrammar::Items;
  using Next = std::function<bool(std::size_t)>;

  explicit Matcher(std::string_view text) : text_(text) {}

  bool Match(const Node& node, std::size_t at, const Next& next) {
    // A continuation runs within the match before it, so a long sequence is a deep call, too.
    if (!Spend(0)) return false;
    const Deeper deeper(depth_);
    at = SkipBlanks(text_, at);
    switch (node.kind) {
      case Node::Kind::kSequence:
        return MatchSequence(node, 0, at, next);
      case Node::Kind::kAlternatives:
        for (const auto& child : node.children) {
          if (Attempt([&] { return Match(*child, at, next); })) return true;
        }
        return false;
      case Node::Kind::kOptional:
        if (Attempt([&] { return Match(*node.children.front(), at, next); })) return true;
        return next(at);
      case Node::Kind::kRepeat:
        return MatchRepeat(*node.children.front(), at, next);
      case Node::Kind::kText:
      case Node::Kind::kMarkup:
        return Spend(text_.size() - at) && MatchRest(node, text_.substr(at), next);
      case Node::Kind::kFile:
        return MatchFile(at, next);
      case Node::Kind::kTime:
        return MatchTime(at, next);
      default:
        return MatchWord(node, at, next);
    }
  }

  Items TakeItems() { return std::move(items_); }
  std::size_t farthest() const { return farthest_; }
  bool exhausted() const { return exhausted_; }
  void Reached(std::size_t at) { farthest_ = std::max(farthest_, at); }

 private:
  /// Bounds the work of a hostile value against an ambiguous grammar.
  static constexpr std::size_t kMaxSteps = 200'000;
  static constexpr std::size_t kStepsPerByte = 16;
  static constexpr std::size_t kBytesPerStep = 64;  // copied or looked through
  static constexpr int kMaxCalls = 1'000;           // each takes about a kilobyte of the stack
  /// One step, and `bytes` of the value looked at. False for good once all steps are taken.
  bool Spend(std::size_t bytes) {
    steps_ += 1 + bytes / kBytesPerStep;
    exhausted_ =
        exhausted_ || depth_ >= kMaxCalls || steps_ > kMaxSteps + kStepsPerByte * text_.size();
    return !exhausted_;
  }
  struct Deeper {
    explicit Deeper(int& calls) : depth(calls) { ++depth; }
    ~Deeper() { --depth; }
    Deeper(const Deeper&) = delete;
    int& depth;
  };

  template <typename F>
  bool Attempt(const F& attempt) {
    const std::size_t kept = items_.size();
    if (attempt()) return true;
    items_.resize(kept);
    return false;
  }

  bool Take(std::string text, double number, std::size_t end, const Next& next,
            std::vector<std::string> files = {}) {
    items_.push_back({std::move(text), number, std::move(files)});
    Reached(SkipBlanks(text_, end));
    if (next(end)) return true;
    items_.pop_back();
    return false;
  }

  bool MatchSequence(const Node& node, std::size_t index, std::size_t at, const Next& next) {
    if (index == node.children.size()) return next(at);
    return Match(*node.children[index], at,
                 [&, index](std::size_t end) { return MatchSequence(node, index + 1, end, next); });
  }

  /// Greedy and without backtracking into earlier rounds, so that a long list takes neither deep
  /// recursion nor exponential time; what follows a repeat in our grammars never needs more.
  bool MatchRepeat(const Node& node, std::size_t at, const Next& next) {
    const std::size_t kept = items_.size();
    bool any = false;
    while (true) {
      std::size_t end = at;
      const std::size_t before = items_.size();
      // The items of one round are kept although the continuation "fails" on purpose of returning:
      // it always accepts, so Match leaves them in place.
      if (!Match(node, at, [&end](std::size_t e) { return end = e, true; }) || end == at) {
        items_.resize(before);
        break;
      }
      any = true;
      at = end;
    }
    if (any && next(at)) return true;
    items_.resize(kept);
    return false;
  }

  bool MatchRest(const Node& node, std::string_view rest, const Next& next) {
    auto files = node.kind == Node::Kind::kMarkup ? SourcesIn(rest) : std::vector<std::string>{};
    return Take(std::string(rest), 0, text_.size(), next, std::move(files));
  }

  bool MatchFile(std::size_t at, const Next& next) {
    if (at >= text_.size() || !Spend(text_.size() - at)) return false;
    std::size_t end = text_.size();
    while (end > at && IsBlank(text_[end - 1])) --end;
    std::string name(text_.substr(at, end - at));
    if (text_[at] == '"') {
      auto quoted = ReadQuoted(text_, at);
      if (!quoted || quoted->first.empty() || quoted->second != end) return false;
      name = std::move(quoted->first);
    }
    return Take(name, 0, text_.size(), next, {name});
  }

  bool MatchTime(std::size_t at, const Next& next) {
    // "+ 500" is one time in two words: try the longer reading first.
    const std::size_t one = WordEnd(text_, at);
    const std::size_t two = WordEnd(text_, SkipBlanks(text_, one));
    if (!Spend(two - at)) return false;
    for (const std::size_t end : {two, one}) {
      const auto start = ParseStartTime(text_.substr(at, end - at));
      if (start && Attempt([&] { return Take(FormatStartTime(*start), 0, end, next); }))
        return true;
    }
    return false;
  }

  bool MatchWord(const Node& node, std::size_t at, const Next& next) {
    if (at >= text_.size()) return false;
    if (node.kind == Node::Kind::kWord && text_[at] == '"') {
      auto quoted = ReadQuoted(text_, at);
      if (!Spend((quoted ? quoted->second : text_.size()) - at)) return false;
      return quoted && Take(std::move(quoted->first), 0, quoted->second, next);
    }
    const std::size_t end = WordEnd(text_, at);
    if (!Spend(end - at)) return false;
    const std::string_view word = text_.substr(at, end - at);
    if (node.kind == Node::Kind::kWord) return Take(std::string(word), 0, end, next);
    if (node.kind == Node::Kind::kLiteral) {
      return EqualsIgnoringCase(word, node.literal) && Take(node.literal, 0, end, next);
    }
    const auto number = ReadNumber(word);
    if (!number || *number < node.low || *number > node.high) return false;
    if (node.kind == Node::Kind::kInt && *number != std::floor(*number)) return false;
    return Take(std::string(word), *number, end, next);
  }

  std::string_view text_;
  Items items_;
  std::size_t farthest_ = 0;
  std::size_t steps_ = 0;
  bool exhausted_ = false;
  int depth_ = 0;
};

}  // namespace

Result<ValueGrammar> ValueGrammar::Parse(std::string_view text) {
  if (text.size() > kMaxBytes)
    return Fail(Errc::kBadValue, "a value grammar of " + std::to_string(text.size()) +
                                     " bytes, expected at most " + std::to_string(kMaxBytes));
  // ';' stands between the grammars of Slots.files; what is not text cannot be shown.
  for (std::size_t at = 0; at < text.size();) {
    const auto sign = DecodeUtf8(text, at);
    if (!sign || sign->value < 0x20 || sign->value == 0x7F || sign->value == ';')
      return Fail(Errc::kBadValue, "value grammar: found ';' or what is no text, expected words",
                  at + 1);
    at += sign->length;
  }
  try {
    return ValueGrammar(text, GrammarReader<Node>(text).Read());
  } catch (const GrammarFault& fault) {
    const std::string found = fault.at < text.size()
                                  ? "'" + ShownUtf8(CutUtf8(text.substr(fault.at), 40)) + "'"
                                  : "the end";
    return Fail(Errc::kBadValue, "value grammar: found " + found + ", expected " + fault.expected,
                fault.at + 1);
  }
}

ValueGrammar::ValueGrammar(std::string_view text) {
  auto parsed = Parse(text);
  if (!parsed) throw std::logic_error(FormatError(parsed.error()));
  *this = std::move(*parsed);
}

ValueGrammar::ValueGrammar(std::string_view text, std::unique_ptr<Node> root)
    : text_(text), root_(std::move(root)) {}

bool ValueGrammar::has_file() const {
  return text_.contains("<file>") || text_.contains("<markup>");
}
bool ValueGrammar::has_text() const {
  return text_.contains("<text>") || text_.contains("<markup>");
}

/// The literal words of the grammar.
std::vector<std::string> ValueGrammar::Words() const {
  std::vector<std::string> words;
  std::vector<const Node*> open{root_.get()};
  while (!open.empty()) {
    const Node* node = open.back();
    open.pop_back();
    if (node->kind == Node::Kind::kLiteral) words.push_back(node->literal);
    for (const auto& child : node->children) open.push_back(child.get());
  }
  return words;
}

ValueGrammar::~ValueGrammar() = default;
ValueGrammar::ValueGrammar(ValueGrammar&&) noexcept = default;
ValueGrammar& ValueGrammar::operator=(ValueGrammar&&) noexcept = default;

Result<ValueGrammar::Items> ValueGrammar::Match(std::string_view value) const {
  Matcher<Node> matcher(value);
  const bool fits = matcher.Match(*root_, 0, [&](std::size_t end) {
    end = SkipBlanks(value, end);
    matcher.Reached(end);
    return end == value.size();
  });
  if (fits) return matcher.TakeItems();
  if (matcher.exhausted())
    return Fail(Errc::kLimit, "the value takes too many steps to be compared with " + text_);
  const std::size_t at = SkipBlanks(value, matcher.farthest());
  std::string found = "the end of the value";
  std::string guess;
  if (at < value.size()) {
    const std::string_view word = value.substr(at, WordEnd(value, at) - at);
    found = "'" + ShownUtf8(CutUtf8(word, 40)) + "'";
    guess = DidYouMean(word, Words());
  }
  return Fail(Errc::kBadValue, "found " + found + ", expected " + text_ + guess, at + 1);
}

}  // namespace vm
