#include <algorithm>
#include <set>

#include "task_manager/grammar/abnf_scanner.h"
#include "task_manager/grammar/compiler.h"

namespace vxml::srgs {

using Kind = Expansion::Kind;

namespace {

using Made = vm::Result<std::unique_ptr<Expansion>>;

class AbnfCompiler {
 public:
  AbnfCompiler(std::string_view text, const GrammarContext& context)
      : context_(context), in_(text, context.uri) {}

  vm::Result<std::unique_ptr<Grammar>> Run() {
    grammar_ = MakeGrammar(context_);
    grammar_->base = context_.base;
    grammar_->form = Form::kAbnf;
    if (in_.Looks("#ABNF")) {
      if (auto done = Header(); !done) return std::unexpected(done.error());
    } else if (context_.alone) {
      return in_.Bad("the first characters must be '#ABNF 1.0'");
    }
    while (in_.SkipBlank(), !in_.OpenComment() && !in_.AtEnd()) {
      if (auto done = Statement(); !done) return std::unexpected(done.error());
    }
    if (in_.OpenComment()) return in_.Bad("a comment without end");
    if (auto done = CheckTokens(*grammar_); !done) return in_.Bad(done.error().text);
    if (auto done = CheckHeader(*grammar_, context_); !done) return in_.Bad(done.error().text);
    return std::move(grammar_);
  }

 private:
  /// #ABNF 1.0 CHARSET; (the charset has been used by now).
  vm::Result<void> Header() {
    const AbnfScanner start = in_;
    auto line = in_.Until(";", "';' expected after the header");
    if (!line) return std::unexpected(line.error());
    const std::string header = context_.alone ? *line : vm::xml::Collapse(*line);
    const std::string_view rest =
        std::string_view(header).substr(std::min<std::size_t>(9, header.size()));
    const bool charset = rest.size() > 1 && rest[0] == ' ' &&
                         rest.find_first_of(" \t\r\n", 1) == std::string_view::npos;
    if (!header.starts_with("#ABNF 1.0") || (!rest.empty() && !charset)) {
      return start.Bad("'" + *line + ";', expected '#ABNF 1.0;' or '#ABNF 1.0 CHARSET;'");
    }
    if (!context_.alone) return {};
    while (in_.Peek() == ' ' || in_.Peek() == '\t') in_.Skip(1);
    if (in_.AtEnd() || in_.Peek() == '\n' || in_.Peek() == '\r') return {};
    return in_.Bad("a new line expected behind the header");
  }

  vm::Result<void> Statement() {
    if (in_.Peek() == '$') return RuleDefinition(false);
    if (in_.Peek() == '{') {
      if (!grammar_->rules.empty()) return in_.Bad("a tag after a rule");
      auto tag = Tag();
      if (!tag) return std::unexpected(tag.error());
      grammar_->header_tags.push_back((*tag)->text);
      return End();
    }
    const std::string word = in_.Word();
    if (word == "public" || word == "private") return RuleDefinition(word == "public");
    if (!grammar_->rules.empty()) return in_.Bad("'" + word + "' after a rule");
    static const std::set<std::string> kOnce = {"language", "mode", "root", "tag-format", "base"};
    if (kOnce.contains(word) && !declared_.insert(word).second) {
      return in_.Bad("a second declaration of " + word);
    }
    if (auto done = Declaration(word); !done) return done;
    return End();
  }

  vm::Result<void> Declaration(const std::string& word) {
    if (word == "language") {
      grammar_->language = in_.Word();
      if (!IsLanguage(grammar_->language)) {
        return in_.Bad("'" + grammar_->language + "' is no language");
      }
    } else if (word == "mode") {
      const std::string mode = in_.Word();
      if (mode != "voice" && mode != "dtmf") return in_.Bad("mode '" + mode + "'");
      grammar_->mode = mode == "dtmf" ? Mode::kDtmf : Mode::kVoice;
    } else if (word == "root") {
      auto root = RuleName();
      if (!root) return std::unexpected(root.error());
      grammar_->root = *root;
    } else if (word == "tag-format" || word == "base" || word == "lexicon") {
      auto uri = in_.Uri(context_.alone);
      if (!uri) return std::unexpected(uri.error());
      if (word == "tag-format") grammar_->tag_format = *uri;
      if (word == "base") grammar_->base = *uri;
    } else if (word == "meta" || word == "http-equiv") {
      if (auto name = in_.Quoted(); !name) return std::unexpected(name.error());
      if (in_.Word() != "is") return in_.Bad("expected 'is'");
      if (auto content = in_.Quoted(); !content) return std::unexpected(content.error());
    } else {
      return in_.Bad("'" + (word.empty() ? std::string(1, in_.Peek()) : word) +
                     "' found, expected a declaration or a rule");
    }
    return {};
  }

  vm::Result<void> End() {
    if (!in_.Take(';')) return in_.Bad("';' expected");
    return {};
  }

  /// "$name", which is one token: without a blank inside (SRGS 1.0 appendix D).
  vm::Result<std::string> RuleName() {
    if (!in_.Take('$')) return in_.Bad("'$' and the rule's name expected");
    if (context_.alone && in_.AtBlank()) return in_.Bad("a blank behind '$'");
    return in_.Word();
  }

  vm::Result<void> RuleDefinition(bool is_public) {
    auto written = RuleName();
    if (!written) return std::unexpected(written.error());
    auto rule = std::make_unique<Rule>();
    rule->name = *written;
    rule->is_public = is_public;
    rule->grammar = grammar_.get();
    rule->line = in_.line();
    rule->column = in_.column();
    if (!IsRuleName(rule->name)) return in_.Bad("'" + rule->name + "' is no name of a rule");
    if (IsSpecialRule(rule->name)) {
      return in_.Bad("'$" + rule->name + "' is a special rule and cannot be defined");
    }
    if (grammar_->rules.contains(rule->name)) {
      return in_.Bad("rule '$" + rule->name + "' is defined twice");
    }
    if (!in_.Take('=')) return in_.Bad("'=' expected");
    auto expansion = Alternatives(1);
    if (!expansion) return std::unexpected(expansion.error());
    rule->expansion = std::move(*expansion);
    const std::string name = rule->name;
    grammar_->rules.emplace(name, std::move(rule));
    return End();
  }

  Made Alternatives(std::size_t depth) {
    if (depth > kMaxGrammarDepth) {
      return in_.Bad("nested deeper than " + std::to_string(kMaxGrammarDepth));
    }
    auto choice = std::make_unique<Expansion>();
    choice->kind = Kind::kAlternatives;
    do {
      double weight = 1;
      in_.SkipBlank();
      if (in_.Peek() == '/') {
        auto given = in_.Slashed();
        if (!given) return std::unexpected(given.error());
        weight = *given;
        if (weight <= 0) return in_.Bad("a weight above 0 expected");
      }
      auto sequence = Sequence(depth + 1);
      if (!sequence) return sequence;
      choice->children.push_back(std::move(*sequence));
      choice->weights.push_back(weight);
    } while (in_.Take('|'));
    if (choice->children.size() == 1) return std::move(choice->children[0]);
    return choice;
  }

  Made Sequence(std::size_t depth) {
    auto sequence = std::make_unique<Expansion>();
    sequence->kind = Kind::kSequence;
    while (true) {
      in_.SkipBlank();
      const char c = in_.Peek();
      if (in_.OpenComment() || c == '\0' || c == ';' || c == '|' || c == ')' || c == ']') break;
      auto part = Sub(depth);
      if (!part) return part;
      if (auto done = Suffixes(*part); !done) return std::unexpected(done.error());
      sequence->children.push_back(std::move(*part));
    }
    if (sequence->children.empty()) return in_.Bad("an expansion expected");
    return sequence;
  }

  Made Sub(std::size_t depth) {
    if (++expansions_ > kMaxExpansions) return in_.Bad("too many words and parts");
    switch (in_.Peek()) {
      case '(':
        return Group(depth, ')');
      case '[':
        return Group(depth, ']');
      case '{':
        return Tag();
      case '$':
        return Reference();
      case '"': {
        auto text = in_.Quoted();
        if (!text) return std::unexpected(text.error());
        return MakeToken(*text);
      }
      default: {
        std::string word = in_.Word();
        const char sign = in_.Peek();
        if (word.empty() && !context_.alone && (sign == '*' || sign == '+')) {  // keys
          word = sign;
          in_.Skip(1);
        }
        if (word.empty()) return in_.Bad(std::string("'") + sign + "' is not expected here");
        return MakeToken(word);
      }
    }
  }

  Made Group(std::size_t depth, char close) {
    in_.Skip(1);
    if (close == ')' && in_.Take(')')) {  // () matches nothing said
      auto empty = std::make_unique<Expansion>();
      empty->kind = Kind::kNull;
      return empty;
    }
    auto inner = Alternatives(depth + 1);
    if (!inner) return inner;
    if (!in_.Take(close)) return in_.Bad(std::string("'") + close + "' expected");
    if (close == ')') return inner;
    auto optional = MakeRepeat(std::move(*inner));
    SetTurns(*optional, 0, 1);
    return optional;
  }

  Made Tag() {
    const bool long_form = in_.Looks("{!{");
    in_.Skip(long_form ? 3 : 1);
    auto text = in_.Until(long_form ? "}!}" : "}", "a tag without end");
    if (!text) return std::unexpected(text.error());
    auto tag = std::make_unique<Expansion>();
    tag->kind = Kind::kTag;
    tag->text = std::move(*text);
    return tag;
  }

  Made Reference() {
    auto reference = std::make_unique<Expansion>();
    reference->kind = Kind::kReference;
    reference->line = in_.line();
    reference->column = in_.column();
    in_.Skip(1);
    if (in_.Peek() == '<') {
      auto uri = in_.Uri(true, &reference->type);
      if (!uri) return std::unexpected(uri.error());
      if (uri->empty()) return in_.Bad("an empty reference");
      SplitReference(*uri, *reference);
      return reference;
    }
    if (context_.alone && in_.AtBlank()) return in_.Bad("a blank behind '$'");
    const std::string name = in_.Word();
    if (!IsRuleName(name)) return in_.Bad("'$" + name + "' is no reference to a rule");
    if (name == "NULL") reference->kind = Kind::kNull;
    if (name == "VOID") reference->kind = Kind::kVoid;
    if (name == "GARBAGE") reference->kind = Kind::kGarbage;
    reference->text = "#" + name;
    reference->rule = name;
    return reference;
  }

  /// !language and <m-n /probability/> behind an expansion.
  vm::Result<void> Suffixes(std::unique_ptr<Expansion>& part) {
    if (in_.SkipBlank(), in_.Peek() == '!') {
      if (part->kind == Kind::kTag || part->kind == Kind::kReference || part->kind == Kind::kVoid ||
          part->kind == Kind::kGarbage) {
        return in_.Bad("a language belongs to tokens and groups, not to this");
      }
      in_.Skip(1);
      part->language = in_.Word();
      if (!IsLanguage(part->language)) {
        return in_.Bad("'" + part->language + "' behind '!' is no language");
      }
    }
    if (!in_.Take('<')) return {};
    auto given = in_.Until(">", "'>' expected");
    if (!given) return std::unexpected(given.error());
    auto repeat = MakeRepeat(std::move(part));
    if (auto done = ParseRepeatOperator(*given, *repeat); !done) {
      return in_.Bad(done.error().text);
    }
    part = std::move(repeat);
    if (in_.SkipBlank(), in_.Peek() == '<') return in_.Bad("a second repeat of one expansion");
    return {};
  }

  const GrammarContext& context_;
  std::size_t expansions_ = 0;
  AbnfScanner in_;
  std::unique_ptr<Grammar> grammar_;
  std::set<std::string> declared_;
};

}  // namespace

vm::Result<std::unique_ptr<Grammar>> CompileAbnf(std::string_view text,
                                                 const GrammarContext& context) {
  return AbnfCompiler(text, context).Run();
}

}  // namespace vxml::srgs
