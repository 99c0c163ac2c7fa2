#include <set>

#include "task_manager/grammar/compiler.h"

namespace vxml::srgs {
namespace {

using Kind = Expansion::Kind;
using Made = vm::Result<std::unique_ptr<Expansion>>;

constexpr std::string_view kBlanks = " \t\r\n";
/// What ends an unquoted token.
constexpr std::string_view kTokenEnds = " \t\r\n;=|*+<>(){}[]/!$\"";

class AbnfCompiler {
 public:
  AbnfCompiler(std::string_view text, const GrammarContext& context)
      : text_(text), context_(context) {}

  vm::Result<std::unique_ptr<Grammar>> Run() {
    grammar_ = std::make_unique<Grammar>();
    grammar_->uri = context_.uri;
    grammar_->base = context_.base;
    grammar_->language = context_.language;
    grammar_->mode = context_.mode;
    if (text_.starts_with("#ABNF")) {
      const std::size_t end = text_.find(';');
      if (end == std::string_view::npos) return Bad("';' expected after the header");
      const std::string header = "" + std::string(text_.substr(5, end - 5));
      const std::size_t version = header.find_first_not_of(" \t");
      if (version == std::string::npos || header.compare(version, 3, "1.0") != 0 ||
          (version + 3 < header.size() && kBlanks.find(header[version + 3]) == std::string::npos)) {
        return Bad("expected '#ABNF 1.0'");
      }
      at_ = end + 1;
    }
    while (SkipBlank(), !failed_ && at_ < text_.size()) {
      if (auto done = Statement(); !done) return std::unexpected(done.error());
    }
    if (failed_) return Bad("a comment without end");
    if (auto done = CheckTokens(*grammar_); !done) return Bad(done.error().text);
    if (!grammar_->root.empty() && !grammar_->Find(grammar_->root)) {
      return Bad("root rule '$" + grammar_->root + "' is not defined");
    }
    if (grammar_->root.empty() && grammar_->rules.size() == 1) {
      grammar_->root = grammar_->rules.begin()->first;
    }
    return std::move(grammar_);
  }

 private:
  std::unexpected<vm::Error> Bad(const std::string& what) const {
    std::size_t line = 1;
    std::size_t start = 0;
    for (std::size_t i = 0; i < std::min(at_, text_.size()); ++i) {
      if (text_[i] == '\n') {
        ++line;
        start = i + 1;
      }
    }
    return vm::Fail(vm::Errc::kSyntax, context_.uri + ":" + std::to_string(line) + ":" +
                                           std::to_string(at_ - start + 1) + ": " + what);
  }

  std::string_view Rest() const { return text_.substr(std::min(at_, text_.size())); }
  bool Looks(std::string_view sign) const { return Rest().starts_with(sign); }
  char Peek() const { return at_ < text_.size() ? text_[at_] : '\0'; }

  void SkipBlank() {
    while (at_ < text_.size()) {
      if (kBlanks.find(text_[at_]) != std::string_view::npos) {
        ++at_;
      } else if (Looks("//")) {
        at_ = std::min(text_.find('\n', at_), text_.size());
      } else if (Looks("/*")) {
        const std::size_t end = text_.find("*/", at_ + 2);
        if (end == std::string_view::npos) {
          failed_ = true;
          at_ = text_.size();
          return;
        }
        at_ = end + 2;
      } else {
        return;
      }
    }
  }
  bool Take(char sign) {
    SkipBlank();
    if (Peek() != sign) return false;
    ++at_;
    return true;
  }
  std::string Word() {
    SkipBlank();
    const std::size_t end = std::min(text_.find_first_of(kTokenEnds, at_), text_.size());
    std::string word(text_.substr(at_, end - at_));
    at_ = end;
    return word;
  }

  vm::Result<void> Statement() {
    if (Peek() == '{') {
      auto tag = Tag();
      if (!tag) return std::unexpected(tag.error());
      grammar_->header_tags.push_back((*tag)->text);
      return End();
    }
    if (Peek() == '$') return RuleDefinition(false);
    const std::string word = Word();
    if (word == "public" || word == "private") return RuleDefinition(word == "public");
    if (!grammar_->rules.empty()) return Bad("'" + word + "' after a rule");
    static const std::set<std::string> kOnce = {"language", "mode", "root", "tag-format", "base"};
    if (kOnce.contains(word) && !declared_.insert(word).second) {
      return Bad("a second declaration of " + word);
    }
    if (word == "language") {
      grammar_->language = Word();
      if (grammar_->language.empty()) return Bad("a language expected");
    } else if (word == "mode") {
      const std::string mode = Word();
      if (mode != "voice" && mode != "dtmf") return Bad("mode '" + mode + "'");
      grammar_->mode = mode == "dtmf" ? Mode::kDtmf : Mode::kVoice;
    } else if (word == "root") {
      if (!Take('$')) return Bad("expected '$' and the root rule's name");
      grammar_->root = Word();
    } else if (word == "tag-format" || word == "base" || word == "lexicon") {
      auto uri = Uri();
      if (!uri) return std::unexpected(uri.error());
      if (word == "tag-format") grammar_->tag_format = *uri;
      if (word == "base") grammar_->base = *uri;
    } else if (word == "meta" || word == "http-equiv") {
      if (auto name = Quoted(); !name) return std::unexpected(name.error());
      if (Word() != "is") return Bad("expected 'is'");
      if (auto content = Quoted(); !content) return std::unexpected(content.error());
    } else {
      return Bad("'" + (word.empty() ? std::string(1, Peek()) : word) +
                 "' found, expected a declaration or a rule");
    }
    return End();
  }

  vm::Result<void> End() {
    if (!Take(';')) return Bad("';' expected");
    return {};
  }

  /// <URI> with an optional ~<media type>; also without brackets, as older grammars write.
  vm::Result<std::string> Uri(std::string* type = nullptr) {
    SkipBlank();
    if (Peek() != '<') return Word();
    const std::size_t end = text_.find('>', at_);
    if (end == std::string_view::npos) return Bad("'>' expected");
    std::string uri(xml::Trim(text_.substr(at_ + 1, end - at_ - 1)));
    at_ = end + 1;
    if (Peek() == '~') {
      ++at_;
      auto media = Uri();
      if (!media) return media;
      if (type) *type = *media;
    }
    return uri;
  }

  vm::Result<std::string> Quoted() {
    SkipBlank();
    const char quote = Peek();
    if (quote != '"' && quote != '\'') return Bad("a string in quotes expected");
    const std::size_t end = text_.find(quote, at_ + 1);
    if (end == std::string_view::npos) return Bad("a string without end");
    std::string value(text_.substr(at_ + 1, end - at_ - 1));
    at_ = end + 1;
    return value;
  }

  vm::Result<void> RuleDefinition(bool is_public) {
    if (!Take('$')) return Bad("'$' and the rule's name expected");
    auto rule = std::make_unique<Rule>();
    rule->name = Word();
    rule->is_public = is_public;
    rule->grammar = grammar_.get();
    if (!IsRuleName(rule->name)) return Bad("'" + rule->name + "' is no name of a rule");
    if (rule->name == "NULL" || rule->name == "VOID" || rule->name == "GARBAGE") {
      return Bad("'$" + rule->name + "' is a special rule and cannot be defined");
    }
    if (grammar_->rules.contains(rule->name)) {
      return Bad("rule '$" + rule->name + "' is defined twice");
    }
    if (!Take('=')) return Bad("'=' expected");
    auto expansion = Alternatives(1);
    if (!expansion) return std::unexpected(expansion.error());
    rule->expansion = std::move(*expansion);
    const std::string name = rule->name;
    grammar_->rules.emplace(name, std::move(rule));
    return End();
  }

  Made Alternatives(std::size_t depth) {
    if (depth > kMaxGrammarDepth) {
      return Bad("nested deeper than " + std::to_string(kMaxGrammarDepth));
    }
    auto choice = std::make_unique<Expansion>();
    choice->kind = Kind::kAlternatives;
    do {
      double weight = 1;
      SkipBlank();
      if (Peek() == '/') {
        auto given = Slashed();
        if (!given) return std::unexpected(given.error());
        weight = *given;
        if (weight <= 0) return Bad("a weight above 0 expected");
      }
      auto sequence = Sequence(depth + 1);
      if (!sequence) return sequence;
      choice->children.push_back(std::move(*sequence));
      choice->weights.push_back(weight);
    } while (Take('|'));
    if (choice->children.size() == 1) return std::move(choice->children[0]);
    return choice;
  }

  vm::Result<double> Slashed() {
    const std::size_t end = text_.find('/', at_ + 1);
    if (end == std::string_view::npos) return Bad("'/' expected after the number");
    const std::string_view number = xml::Trim(text_.substr(at_ + 1, end - at_ - 1));
    double value = 0;
    if (!ParseWeight(number, value)) {
      return Bad("'" + std::string(number) + "' is not a number");
    }
    at_ = end + 1;
    return value;
  }

  Made Sequence(std::size_t depth) {
    auto sequence = std::make_unique<Expansion>();
    sequence->kind = Kind::kSequence;
    while (true) {
      SkipBlank();
      const char c = Peek();
      if (failed_ || c == '\0' || c == ';' || c == '|' || c == ')' || c == ']') break;
      auto part = Sub(depth);
      if (!part) return part;
      if (auto done = Suffixes(*part); !done) return std::unexpected(done.error());
      sequence->children.push_back(std::move(*part));
    }
    if (sequence->children.empty()) return Bad("an expansion expected");
    return sequence;
  }

  Made Sub(std::size_t depth) {
    switch (Peek()) {
      case '(':
        return Group(depth, ')');
      case '[':
        return Group(depth, ']');
      case '{':
        return Tag();
      case '$':
        return Reference();
      case '"': {
        auto text = Quoted();
        if (!text) return std::unexpected(text.error());
        return MakeToken(*text);
      }
      default: {
        std::string word = Word();
        if (word.empty() && (Peek() == '*' || Peek() == '+')) word = text_[at_++];  // keys
        if (word.empty()) return Bad(std::string("'") + Peek() + "' is not expected here");
        return MakeToken(word);
      }
    }
  }

  Made Group(std::size_t depth, char close) {
    ++at_;
    if (close == ')' && Take(')')) {  // () matches nothing said
      auto empty = std::make_unique<Expansion>();
      empty->kind = Kind::kNull;
      return empty;
    }
    auto inner = Alternatives(depth + 1);
    if (!inner) return inner;
    if (!Take(close)) return Bad(std::string("'") + close + "' expected");
    if (close == ')') return inner;
    auto optional = std::make_unique<Expansion>();
    optional->kind = Kind::kRepeat;
    optional->min = 0;
    optional->max = 1;
    optional->children.push_back(std::move(*inner));
    return optional;
  }

  Made Tag() {
    const bool long_form = Looks("{!{");
    const std::string_view close = long_form ? "}!}" : "}";
    const std::size_t begin = at_ + (long_form ? 3 : 1);
    const std::size_t end = text_.find(close, begin);
    if (end == std::string_view::npos) return Bad("a tag without end");
    auto tag = std::make_unique<Expansion>();
    tag->kind = Kind::kTag;
    tag->text = text_.substr(begin, end - begin);
    at_ = end + close.size();
    return tag;
  }

  Made Reference() {
    ++at_;
    auto reference = std::make_unique<Expansion>();
    reference->kind = Kind::kReference;
    if (Peek() == '<') {
      auto uri = Uri(&reference->type);
      if (!uri) return std::unexpected(uri.error());
      if (uri->empty()) return Bad("an empty reference");
      SplitReference(*uri, *reference);
      return reference;
    }
    const std::string name = Word();
    if (!IsRuleName(name)) return Bad("'$" + name + "' is no reference to a rule");
    if (name == "NULL") reference->kind = Kind::kNull;
    if (name == "VOID") reference->kind = Kind::kVoid;
    if (name == "GARBAGE") reference->kind = Kind::kGarbage;
    reference->text = "#" + name;
    reference->rule = name;
    return reference;
  }

  /// !language and <m-n /probability/> behind an expansion.
  vm::Result<void> Suffixes(std::unique_ptr<Expansion>& part) {
    if (Peek() == '!') {
      ++at_;
      part->language = Word();
      if (part->language.empty()) return Bad("a language expected after '!'");
    }
    while (SkipBlank(), Peek() == '<') {
      const std::size_t end = text_.find('>', at_);
      if (end == std::string_view::npos) return Bad("'>' expected");
      std::string_view inside = text_.substr(at_ + 1, end - at_ - 1);
      if (const std::size_t slash = inside.find('/'); slash != std::string_view::npos) {
        std::string_view chance = xml::Trim(inside.substr(slash + 1));
        double value = 0;
        if (!chance.ends_with('/')) return Bad("'/' expected after the probability");
        chance.remove_suffix(1);
        if (!ParseWeight(chance, value) || value > 1)
          return Bad("a probability of 0 to 1 expected");
        inside = inside.substr(0, slash);
      }
      auto repeat = std::make_unique<Expansion>();
      repeat->kind = Kind::kRepeat;
      if (!ParseRepeat(xml::Trim(inside), repeat->min, repeat->max)) {
        return Bad("repeat <" + std::string(inside) + ">, expected <N>, <N-M> or <N->");
      }
      at_ = end + 1;
      repeat->children.push_back(std::move(part));
      part = std::move(repeat);
    }
    return {};
  }

  std::string_view text_;
  const GrammarContext& context_;
  std::unique_ptr<Grammar> grammar_;
  std::set<std::string> declared_;
  std::size_t at_ = 0;
  bool failed_ = false;
};

}  // namespace

vm::Result<std::unique_ptr<Grammar>> CompileAbnf(std::string_view text,
                                                 const GrammarContext& context) {
  return AbnfCompiler(text, context).Run();
}

}  // namespace vxml::srgs
