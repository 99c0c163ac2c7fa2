#include "srm_stub/word_grammar.h"

#include <algorithm>
#include <set>
#include <utility>

namespace srm_stub {
namespace {

bool IsAsciiLetter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }
bool IsWordByte(char c) {
  return IsAsciiLetter(c) || (c >= '0' && c <= '9') || c == '\'' || c == '-';
}
bool IsContinuation(char c) { return (static_cast<unsigned char>(c) & 0xC0) == 0x80; }

/// Punctuation of Japanese text is no word.
bool IsWideSign(std::string_view character) {
  static constexpr std::string_view kSigns[] = {"、", "。", "！", "？", "　",
                                                "「", "」", "・", "，", "．"};
  return std::find(std::begin(kSigns), std::end(kSigns), character) != std::end(kSigns);
}

}  // namespace

std::vector<std::string> WordsOf(std::string_view text) {
  std::vector<std::string> words;
  for (std::size_t at = 0; at < text.size();) {
    std::size_t end = at + 1;
    if (IsWordByte(text[at])) {
      while (end < text.size() && IsWordByte(text[end])) ++end;
      std::string word(text.substr(at, end - at));
      for (char& c : word) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c + ('a' - 'A')) : c;
      // A dash or quote alone is a sign.
      if (word.find_first_not_of("'-") != std::string::npos) words.push_back(std::move(word));
    } else if (static_cast<unsigned char>(text[at]) >= 0x80) {
      while (end < text.size() && IsContinuation(text[end])) ++end;
      if (const auto character = text.substr(at, end - at); !IsWideSign(character)) {
        words.emplace_back(character);
      }
    }
    at = end;
  }
  return words;
}

struct WordGrammar::Node {
  enum class Kind { kWord, kAny, kSequence, kChoice };
  Kind kind = Kind::kSequence;
  std::string word{};
  std::vector<Node> parts{};  // kSequence: all in order; kChoice: one of them
  using Places = std::set<std::size_t>;

  /// All places the words can be at after this, from all places they can be at before.
  Places From(const Places& before, const std::vector<std::string>& words) const {
    Places after;
    if (kind == Kind::kSequence) {
      after = before;
      for (const Node& part : parts) after = part.From(after, words);
    } else if (kind == Kind::kChoice) {
      for (const Node& part : parts) after.merge(part.From(before, words));
    } else {
      for (const std::size_t at : before) {
        if (at < words.size() && (kind == Kind::kAny || words[at] == word)) after.insert(at + 1);
      }
    }
    return after;
  }
};

struct WordGrammar::Phrase {
  Node node{};
  std::string meaning{};
};

WordGrammar::WordGrammar() = default;
WordGrammar::~WordGrammar() = default;
WordGrammar::WordGrammar(WordGrammar&&) noexcept = default;
WordGrammar& WordGrammar::operator=(WordGrammar&&) noexcept = default;

class WordGrammar::Parser {
 public:
  explicit Parser(std::string_view text) : text_(text) {}

  vm::Result<std::vector<Phrase>> Phrases() {
    std::vector<Phrase> phrases;
    while (true) {
      auto sequence = Sequence(0);
      if (!sequence) return std::unexpected(sequence.error());
      Phrase phrase{std::move(*sequence), {}};
      if (Peek() == '{') {
        const std::size_t end = text_.find('}', at_);
        if (end == std::string_view::npos) return Expected("'}'");
        phrase.meaning = std::string(text_.substr(at_ + 1, end - at_ - 1));
        at_ = end + 1;
      }
      if (phrase.node.parts.empty()) return Expected("a word");
      phrases.push_back(std::move(phrase));
      if (Peek() == '\0') return phrases;
      if (Peek() != '|') return Expected("'|', '{' or the end");
      ++at_;
    }
  }

 private:
  std::unexpected<vm::Error> Expected(const std::string& what) {
    const std::string found =
        Peek() == '\0' ? "the end" : "'" + std::string(text_.substr(at_, 12)) + "'";
    return vm::Fail(vm::Errc::kSyntax, "found " + found + ", expected " + what, at_ + 1);
  }
  char Peek() {
    while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\t')) ++at_;
    return at_ < text_.size() ? text_[at_] : '\0';
  }

  vm::Result<Node> Sequence(int depth) {
    if (depth > kMaxDepth) return vm::Fail(vm::Errc::kLimit, "nested too deep", at_ + 1);
    Node sequence;
    while (true) {
      const char c = Peek();
      if (c == '*') {
        ++at_;
        sequence.parts.push_back({Node::Kind::kAny, {}, {}});
      } else if (c == '[' || c == '(') {
        auto group = Group(depth + 1, c == '[' ? ']' : ')');
        if (!group) return group;
        sequence.parts.push_back(std::move(*group));
      } else if (c == '\0' || std::string_view("|{}])").find(c) != std::string_view::npos) {
        return sequence;
      } else {
        const std::size_t end = std::min(text_.find_first_of(" \t|{}[]()*", at_), text_.size());
        for (std::string& word : WordsOf(text_.substr(at_, end - at_))) {
          sequence.parts.push_back({Node::Kind::kWord, std::move(word), {}});
        }
        at_ = end;
      }
    }
  }

  vm::Result<Node> Group(int depth, char close) {
    ++at_;
    Node choice{Node::Kind::kChoice, {}, {}};
    while (true) {
      auto sequence = Sequence(depth);
      if (!sequence) return sequence;
      if (sequence->parts.empty()) return Expected("a word");
      choice.parts.push_back(std::move(*sequence));
      const char c = Peek();
      if (c != '|' && c != close) return Expected("'|' or '" + std::string(1, close) + "'");
      ++at_;
      if (c == close) break;
    }
    if (close == ']') choice.parts.push_back(Node{});  // or nothing
    return choice;
  }

  std::string_view text_;
  std::size_t at_ = 0;
};

vm::Result<WordGrammar> WordGrammar::Parse(std::string_view text) {
  if (text.size() > kMaxBytes) {
    return vm::Fail(vm::Errc::kTooLong, "the grammar has " + std::to_string(text.size()) +
                                            " bytes, expected at most " +
                                            std::to_string(kMaxBytes));
  }
  auto phrases = Parser(text).Phrases();
  if (!phrases) return std::unexpected(phrases.error());
  WordGrammar grammar;
  grammar.text_ = std::string(text);
  grammar.phrases_ = std::move(*phrases);
  return grammar;
}

std::optional<std::string> WordGrammar::Match(const std::vector<std::string>& words) const {
  for (const Phrase& phrase : phrases_) {
    if (phrase.node.From({0}, words).contains(words.size())) return phrase.meaning;
  }
  return std::nullopt;
}

}  // namespace srm_stub
