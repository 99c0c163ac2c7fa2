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
        while (at_ < source_.size() && (IsLetter(source_[at_]) || IsDigit(source_[at_]))) ++at_;
      } else if (IsDigit(c) ||
                 (c == '.' && at_ + 1 < source_.size() && IsDigit(source_[at_ + 1]))) {
        type = Token::Type::kNumber;
        SkipNumber();
      } else if (c == '"' || c == '\'') {
        type = Token::Type::kString;
        if (!SkipString(c)) return Bad("a string without end");
      } else if (c == '/' && RegexMayStart()) {
        type = Token::Type::kRegex;
        if (!SkipRegex()) return Bad("a regular expression without end");
      } else {
        ++at_;
      }
      tokens_.push_back({type, source_.substr(start, at_ - start), before, newline});
    }
  }

 private:
  std::unexpected<vm::Error> Bad(const std::string& what) const {
    return vm::Fail(vm::Errc::kSyntax, what, at_ + 1);
  }

  bool SkipGap(bool& newline) {
    while (at_ < source_.size()) {
      const char c = source_[at_];
      const std::string_view rest = source_.substr(at_);
      if (c == '\n' || c == '\r') newline = true;
      if (c == ' ' || (c >= '\t' && c <= '\r')) {
        ++at_;
      } else if (rest.starts_with("\xc2\xa0")) {
        at_ += 2;
      } else if (rest.starts_with("//") || rest.starts_with("<!--")) {
        at_ = std::min(source_.find('\n', at_), source_.size());
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
      } else if (source_[at_] == '\n') {
        return false;
      }
    }
    return false;
  }

  bool SkipRegex() {
    bool in_class = false;
    for (++at_; at_ < source_.size() && source_[at_] != '\n'; ++at_) {
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

  bool RegexMayStart() const {
    if (tokens_.empty()) return true;
    const Token& last = tokens_.back();
    if (last.type == Token::Type::kWord) {
      return std::find(kBeforeOperand.begin(), kBeforeOperand.end(), last.text) !=
             kBeforeOperand.end();
    }
    return last.type == Token::Type::kSign && last.text != ")" && last.text != "]";
  }

  std::string_view source_;
  std::size_t at_ = 0;
  std::vector<Token> tokens_;
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
