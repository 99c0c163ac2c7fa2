#include "task_manager/script/rewriter.h"

#include <algorithm>
#include <utility>

namespace vxml::script {
namespace {

/// One open bracket.
struct Open {
  enum class Role { kPlain, kWhile, kFor, kWith, kParameters, kBody };
  char sign;
  Role role = Role::kPlain;
  bool is_switch = false;
  int semicolons = 0;        // seen directly inside a `for (`
  bool wrapped = false;      // the `for` test got a closing bracket of ours
  bool declaration = false;  // kParameters/kBody of a hoisted function
};

class Rewriter {
 public:
  Rewriter(std::vector<Token> tokens, SourceKind kind) : tokens_(std::move(tokens)), kind_(kind) {
    closing_.resize(tokens_.size(), tokens_.size());
    std::vector<std::size_t> round;
    for (std::size_t i = 0; i < tokens_.size(); ++i) {
      if (tokens_[i].type != Token::Type::kSign) continue;
      if (tokens_[i].text == "(") round.push_back(i);
      if (tokens_[i].text == ")" && !round.empty()) {
        closing_[round.back()] = i;
        round.pop_back();
      }
    }
  }

  vm::Result<Rewritten> Run() {
    for (at_ = 0; at_ < tokens_.size(); ++at_) {
      const Token& token = tokens_[at_];
      out().append(token.before);
      if (token.type == Token::Type::kWord && !IsPropertyName()) {
        Word(token);
      } else if (token.type == Token::Type::kSign) {
        if (!Sign(token)) return vm::Fail(vm::Errc::kSyntax, "brackets do not match");
      } else {
        out().append(token.text);
      }
    }
    if (!open_.empty()) return vm::Fail(vm::Errc::kSyntax, "a bracket is not closed");
    return Rewritten{hoisted_ + body_, std::move(declared_)};
  }

 private:
  std::string& out() { return in_hoisted_ ? hoisted_ : body_; }
  const Token* Next(std::size_t ahead = 1) const {
    return at_ + ahead < tokens_.size() ? &tokens_[at_ + ahead] : nullptr;
  }
  bool NextIs(std::string_view text, std::size_t ahead = 1) const {
    const Token* next = Next(ahead);
    return next && next->text == text;
  }
  /// x.while, {while: 1}
  bool IsPropertyName() const {
    if (at_ > 0 && tokens_[at_ - 1].text == ".") return true;
    return NextIs(":") && at_ > 0 && (tokens_[at_ - 1].text == "{" || tokens_[at_ - 1].text == ",");
  }

  void Word(const Token& token) {
    if (token.text == "while" && NextIs("(")) {
      next_role_ = Open::Role::kWhile;
    } else if (token.text == "for" && NextIs("(")) {
      next_role_ = Open::Role::kFor;
    } else if (token.text == "with" && NextIs("(")) {
      next_role_ = Open::Role::kWith;
    } else if (token.text == "in" && !open_.empty() && open_.back().role == Open::Role::kFor &&
               open_.back().semicolons == 0 && !open_.back().wrapped) {
      open_.back().wrapped = true;
      out().append("in __f(");
      return;
    } else if (token.text == "function") {
      return Function(token);
    } else if (token.text == "var" && functions_ == 0 && kind_ == SourceKind::kScript) {
      return Declare();
    }
    out().append(token.text);
  }

  void Function(const Token& token) {
    const Token* name = Next();
    const bool named = name && name->type == Token::Type::kWord;
    next_role_ = Open::Role::kParameters;
    if (kind_ == SourceKind::kScript && functions_ == 0 && named && InStatementPlace()) {
      in_hoisted_ = true;
      next_is_declaration_ = true;
      AddName(std::string(name->text));
      hoisted_.append(name->text).append("=");
    }
    out().append(token.text);
  }

  bool InStatementPlace() const {
    if (at_ == 0) return true;
    const Token& last = tokens_[at_ - 1];
    if (last.type == Token::Type::kSign) {
      return std::string_view(";{})]").find(last.text) != std::string_view::npos;
    }
    if (last.type != Token::Type::kWord) return true;
    return IsIdentifier(last.text) || last.text == "else" || last.text == "do";
  }

  /// Lists the names of a `var` statement; what follows the keyword is an expression as it stands.
  void Declare() {
    int depth = 0;
    bool name_expected = true;
    for (std::size_t i = at_ + 1; i < tokens_.size(); ++i) {
      const Token& token = tokens_[i];
      if (name_expected) {
        if (token.type != Token::Type::kWord) return;
        AddName(std::string(token.text));
        name_expected = false;
        continue;
      }
      const char c = token.text[0];
      if (token.type == Token::Type::kSign) {
        if (c == '(' || c == '[' || c == '{') ++depth;
        if (c == ')' || c == ']' || c == '}') {
          if (--depth < 0) return;
        }
        if (depth == 0 && c == ';') return;
        if (depth == 0 && c == ',') name_expected = true;
      } else if (depth == 0 && token.newline_before && EndsOperand(tokens_[i - 1])) {
        return;  // a line that ends the statement by itself
      }
    }
  }

  static bool EndsOperand(const Token& token) {
    if (token.type != Token::Type::kSign) return true;
    return token.text == ")" || token.text == "]" || token.text == "}";
  }

  void AddName(std::string name) {
    if (std::find(declared_.begin(), declared_.end(), name) == declared_.end()) {
      declared_.push_back(std::move(name));
    }
  }

  bool Sign(const Token& token) {
    const char c = token.text[0];
    if (c == '(' || c == '[' || c == '{') {
      OpenBracket(c);
      return true;
    }
    if (c == ')' || c == ']' || c == '}') return CloseBracket(c);
    if (c == ';' && !open_.empty() && open_.back().role == Open::Role::kFor) {
      ForSemicolon(open_.back());
      return true;
    }
    out().append(token.text);
    return true;
  }

  /// {name() {..}} and {get name() {..}}: a function without the word.
  bool IsMethod() const {
    if (at_ < 2 || tokens_[at_ - 1].type == Token::Type::kSign) return false;
    if (tokens_[at_ - 1].text == "if" || tokens_[at_ - 1].text == "switch") return false;
    const Token& before = tokens_[at_ - 2];
    return before.text == "{" || before.text == "," || before.text == "get" || before.text == "set";
  }

  void OpenBracket(char c) {
    Open open{c};
    open.is_switch = c == '(' && at_ > 0 && tokens_[at_ - 1].text == "switch";
    if (c == '(' && next_role_ == Open::Role::kPlain && IsMethod()) {
      const std::size_t close = closing_[at_];
      if (close + 1 < tokens_.size() && tokens_[close + 1].text == "{") {
        next_role_ = Open::Role::kParameters;
      }
    }
    // Every block behind a bracket counts, and those that catch: time that is over stays over.
    const bool counted = c == '{' && at_ > 0 && !body_next_ &&
                         ((tokens_[at_ - 1].text == ")" && !closed_switch_) ||
                          (tokens_[at_ - 1].text == "finally" && !WasProperty()));
    if (c == '(' && next_role_ != Open::Role::kPlain) {
      open.role = std::exchange(next_role_, Open::Role::kPlain);
      open.declaration = std::exchange(next_is_declaration_, false);
    } else if (c == '{' && body_next_) {
      open.role = Open::Role::kBody;
      open.declaration = std::exchange(next_is_declaration_, false);
      body_next_ = false;
      ++functions_;
    }
    open_.push_back(open);
    out() += c;
    if (open.role == Open::Role::kWhile) out() += "__t()&&(";
    if (open.role == Open::Role::kWith) out() += "__w(";
    if (open.role == Open::Role::kBody || counted) out() += "__t();";
  }
  bool WasProperty() const { return at_ > 1 && tokens_[at_ - 2].text == "."; }

  bool CloseBracket(char c) {
    if (open_.empty()) return false;
    const Open open = open_.back();
    open_.pop_back();
    if ((open.sign == '(' && c != ')') || (open.sign == '[' && c != ']') ||
        (open.sign == '{' && c != '}')) {
      return false;
    }
    closed_switch_ = open.is_switch;
    if (open.role == Open::Role::kWhile || open.role == Open::Role::kWith ||
        (open.wrapped && open.semicolons < 2)) {
      out() += ')';
    }
    out() += c;
    if (open.role == Open::Role::kParameters) {
      body_next_ = true;
      next_is_declaration_ = open.declaration;
    }
    if (open.role == Open::Role::kBody) {
      --functions_;
      if (open.declaration) {
        hoisted_ += ";\n";
        in_hoisted_ = false;
      }
    }
    return true;
  }

  void ForSemicolon(Open& open) {
    ++open.semicolons;
    if (open.semicolons == 1) {
      open.wrapped = !NextIs(";");
      out() += open.wrapped ? ";__t()&&(" : ";__t()";
    } else {
      out() += open.wrapped && open.semicolons == 2 ? ");" : ";";
    }
  }

  std::vector<Token> tokens_;
  std::vector<std::size_t>
      closing_;  ///< of each round bracket that opens, the token that closes it
  SourceKind kind_;
  std::size_t at_ = 0;
  std::string body_;
  std::string hoisted_;
  bool in_hoisted_ = false;
  std::vector<std::string> declared_;
  std::vector<Open> open_;
  Open::Role next_role_ = Open::Role::kPlain;
  bool next_is_declaration_ = false;
  bool body_next_ = false;
  bool closed_switch_ = false;
  int functions_ = 0;
};

}  // namespace

vm::Result<Rewritten> Rewrite(std::string_view source, SourceKind kind) {
  auto tokens = Tokenize(source);
  if (!tokens) return std::unexpected(tokens.error());
  return Rewriter(std::move(*tokens), kind).Run();
}

}  // namespace vxml::script
