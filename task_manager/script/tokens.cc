#include <algorithm>
#include <array>

#include "task_manager/script/rewriter.h"

namespace vxml::script {
namespace {

constexpr std::array<std::string_view, 36> kReserved = {
    "break",  "case",     "catch",  "class",  "const",  "continue",   "debugger", "default",
    "delete", "do",       "else",   "enum",   "export", "extends",    "false",    "finally",
    "for",    "function", "if",     "import", "in",     "instanceof", "new",      "null",
    "return", "super",    "switch", "this",   "throw",  "true",       "try",      "typeof",
    "var",    "void",     "while",  "with"};

/// Words after which a '/' begins a regular expression.
constexpr std::array<std::string_view, 11> kBeforeOperand = {
    "return", "typeof", "case", "in", "delete", "void", "throw", "new", "else", "do", "instanceof"};

/// Words in front of a bracket after which a statement follows, so a '/' begins a regular
/// expression.
constexpr std::array<std::string_view, 4> kHeaders = {"if", "while", "for", "with"};

/// Blanks and line ends beyond ASCII (ECMA-262 sections 7.2 and 7.3), in UTF-8.
constexpr std::array<std::string_view, 21> kWideBlanks = {
    "\xc2\xa0",     "\xe1\x9a\x80", "\xe1\xa0\x8e", "\xe2\x80\x80", "\xe2\x80\x81", "\xe2\x80\x82",
    "\xe2\x80\x83", "\xe2\x80\x84", "\xe2\x80\x85", "\xe2\x80\x86", "\xe2\x80\x87", "\xe2\x80\x88",
    "\xe2\x80\x89", "\xe2\x80\x8a", "\xe2\x80\xa8", "\xe2\x80\xa9", "\xe2\x80\xaf", "\xe2\x81\x9f",
    "\xe3\x80\x80", "\xef\xbb\xbf", "\xc2\x85"};

template <std::size_t n>
bool IsOneOf(const std::array<std::string_view, n>& words, std::string_view word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

bool IsLetter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' || c == '$' || c == '\\' ||
         static_cast<unsigned char>(c) >= 0x80;
}
bool IsDigit(char c) { return c >= '0' && c <= '9'; }

class Scanner {
 public:
  explicit Scanner(std::string_view source) : source_(source) {}

  vm::Result<std::vector<Token>> Run() {
    while (true) {
      const std::size_t gap = at_;
      bool newline = false;
      if (!SkipGap(newline)) return Bad("a comment without end");
      const std::string_view before = source_.substr(gap, at_ - gap);
      if (at_ >= source_.size()) return std::move(tokens_);
      const std::size_t start = at_;
      Token::Type type = Token::Type::kSign;
      const char c = source_[at_];
      if (IsLetter(c)) {
        type = Token::Type::kWord;
        SkipWord();
        const std::string_view word = source_.substr(start, at_ - start);
        if (word.find('\\') != std::string_view::npos) return Bad("a name with an escape");
        if (IsOurs(word)) return Bad("the name '" + std::string(word) + "' is the engine's own");
      } else if (IsDigit(c) ||
                 (c == '.' && at_ + 1 < source_.size() && IsDigit(source_[at_ + 1]))) {
        type = Token::Type::kNumber;
        SkipNumber();
      } else if (c == '"' || c == '\'') {
        type = Token::Type::kString;
        if (!SkipString(c)) return Bad("a string without end");
      } else if (c == '/') {
        const Slash slash = Meaning();
        if (slash == Slash::kUnclear) return Bad("a '/' that may divide or begin an expression");
        if (slash == Slash::kDivision) {
          ++at_;
        } else {
          type = Token::Type::kRegex;
          if (!SkipRegex()) return Bad("a regular expression without end");
        }
      } else {
        Bracket(c);
        ++at_;
      }
      tokens_.push_back({type, source_.substr(start, at_ - start), before, newline});
    }
  }

 private:
  std::unexpected<vm::Error> Bad(const std::string& what) const {
    return vm::Fail(vm::Errc::kSyntax, what, at_ + 1);
  }

  /// Bytes of a blank or line end beyond ASCII at `at`, 0 for none.
  std::size_t WideBlank(std::size_t at) const {
    if (at >= source_.size() || static_cast<unsigned char>(source_[at]) < 0x80) return 0;
    const std::string_view rest = source_.substr(at);
    for (const std::string_view blank : kWideBlanks) {
      if (rest.starts_with(blank)) return blank.size();
    }
    return 0;
  }
  bool AtLineEnd() const {
    const std::string_view rest = source_.substr(at_);
    return rest[0] == '\n' || rest[0] == '\r' || rest.starts_with("\xe2\x80\xa8") ||
           rest.starts_with("\xe2\x80\xa9");
  }
  void SkipLine() {
    while (at_ < source_.size() && !AtLineEnd()) ++at_;
  }

  bool SkipGap(bool& newline) {
    newline = tokens_.empty();
    while (at_ < source_.size()) {
      const char c = source_[at_];
      const std::string_view rest = source_.substr(at_);
      if (AtLineEnd()) newline = true;
      if (c == ' ' || (c >= '\t' && c <= '\r')) {
        ++at_;
      } else if (const std::size_t wide = WideBlank(at_)) {
        at_ += wide;
      } else if (rest.starts_with("//") || rest.starts_with("<!--") ||
                 (newline && rest.starts_with("-->"))) {
        SkipLine();
      } else if (rest.starts_with("/*")) {
        const std::size_t end = source_.find("*/", at_ + 2);
        if (end == std::string_view::npos) return false;
        newline = newline || source_.substr(at_, end - at_).find('\n') != std::string_view::npos;
        at_ = end + 2;
      } else {
        break;
      }
    }
    return true;
  }

  void SkipWord() {
    while (at_ < source_.size() && (IsLetter(source_[at_]) || IsDigit(source_[at_])) &&
           WideBlank(at_) == 0) {
      ++at_;
    }
  }

  /// Names the rewriter puts in: a script that could give them another meaning would not be
  /// counted.
  static bool IsOurs(std::string_view word) {
    if (word == "__t" || word == "__f" || word == "__w" || word == "__v") return true;
    return word.starts_with("__s") && word.size() > 3 &&
           word.find_first_not_of("0123456789", 3) == std::string_view::npos;
  }

  void SkipNumber() {
    while (at_ < source_.size()) {
      const char c = source_[at_];
      const bool sign_of_exponent =
          (c == '+' || c == '-') && (source_[at_ - 1] == 'e' || source_[at_ - 1] == 'E') &&
          !source_.substr(0, at_).ends_with("0xe") && !source_.substr(0, at_).ends_with("0xE");
      if (!IsDigit(c) && !IsLetter(c) && c != '.' && !sign_of_exponent) break;
      ++at_;
    }
  }

  bool SkipString(char quote) {
    for (++at_; at_ < source_.size(); ++at_) {
      if (source_[at_] == '\\') {
        ++at_;
      } else if (source_[at_] == quote) {
        ++at_;
        return true;
      } else if (source_[at_] == '\n' || source_[at_] == '\r') {
        return false;
      }
    }
    return false;
  }

  bool SkipRegex() {
    bool in_class = false;
    for (++at_; at_ < source_.size() && !AtLineEnd(); ++at_) {
      const char c = source_[at_];
      if (c == '\\') {
        ++at_;
      } else if (c == '[') {
        in_class = true;
      } else if (c == ']') {
        in_class = false;
      } else if (c == '/' && !in_class) {
        ++at_;
        while (at_ < source_.size() && IsLetter(source_[at_])) ++at_;
        return true;
      }
    }
    return false;
  }

  /// Notes which round brackets belong to `if (`, `while (`, `for (`, `with (`.
  void Bracket(char c) {
    if (c == '(') {
      headers_.push_back(!tokens_.empty() && tokens_.back().type == Token::Type::kWord &&
                         !IsProperty(tokens_.size() - 1) && IsOneOf(kHeaders, tokens_.back().text));
    } else if (c == ')' && !headers_.empty()) {
      closed_header_ = headers_.back();
      headers_.pop_back();
    }
  }
  bool IsProperty(std::size_t token) const { return token > 0 && tokens_[token - 1].text == "."; }

  enum class Slash { kDivision, kRegex, kUnclear };

  /// Code taken for an expression would escape the rewriter: what cannot be told from the tokens
  /// alone is refused.
  Slash Meaning() const {
    if (tokens_.empty()) return Slash::kRegex;
    const Token& last = tokens_.back();
    if (last.type == Token::Type::kWord) {
      if (IsProperty(tokens_.size() - 1)) return Slash::kDivision;
      if (IsOneOf(kBeforeOperand, last.text)) return Slash::kRegex;
      const bool statement =
          last.text == "break" || last.text == "continue" || last.text == "debugger";
      return statement ? Slash::kUnclear : Slash::kDivision;
    }
    if (last.type != Token::Type::kSign || last.text == "]") return Slash::kDivision;
    if (last.text == ")") return closed_header_ ? Slash::kRegex : Slash::kDivision;
    if (last.text == "}") return Slash::kUnclear;
    if (last.text == "+" || last.text == "-") {
      // a+++/b/ is a++ + /b/: pairs are taken from the left.
      std::size_t run = 1;
      for (std::size_t i = tokens_.size() - 1; i > 0; --i, ++run) {
        if (!tokens_[i].before.empty() || tokens_[i - 1].text != last.text) break;
      }
      return run % 2 == 0 ? Slash::kDivision : Slash::kRegex;
    }
    return Slash::kRegex;
  }

  std::string_view source_;
  std::size_t at_ = 0;
  std::vector<Token> tokens_;
  std::vector<bool> headers_;
  bool closed_header_ = false;
};

}  // namespace

vm::Result<std::vector<Token>> Tokenize(std::string_view source) { return Scanner(source).Run(); }

bool IsIdentifier(std::string_view text) {
  if (text.empty() || !IsLetter(text[0])) return false;
  for (const char c : text) {
    if ((!IsLetter(c) && !IsDigit(c)) || c == '\\') return false;
  }
  return std::find(kReserved.begin(), kReserved.end(), text) == kReserved.end();
}

}  // namespace vxml::script
