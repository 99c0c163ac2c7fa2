#include "task_manager/grammar/compiler.h"
#include "task_manager/grammar/text.h"

namespace vxml::srgs {
namespace {

using xml::Node;
using Kind = Expansion::Kind;
using Made = vm::Result<std::unique_ptr<Expansion>>;

bool IsSpecial(std::string_view name) {
  return name == "NULL" || name == "VOID" || name == "GARBAGE";
}

class XmlCompiler {
 public:
  explicit XmlCompiler(const GrammarContext& context) : context_(context) {}

  vm::Result<std::unique_ptr<Grammar>> Run(const Node& root) {
    grammar_ = std::make_unique<Grammar>();
    if (auto done = Header(root); !done) return std::unexpected(done.error());
    auto loose = std::make_unique<Expansion>();
    for (const auto& child : root.children) {
      if (auto done = TopLevel(*child, *loose); !done) return std::unexpected(done.error());
    }
    if (auto done = CheckTokens(*grammar_); !done) return Bad(root, done.error().text);
    if (auto done = Close(root, std::move(loose)); !done) return std::unexpected(done.error());
    return std::move(grammar_);
  }

 private:
  std::unexpected<vm::Error> Bad(const Node& at, const std::string& what,
                                 vm::Errc code = vm::Errc::kSyntax) const {
    return vm::Fail(code, context_.uri + ":" + std::to_string(at.line) + ":" +
                              std::to_string(at.column) + ": " + what);
  }

  vm::Result<void> Header(const Node& root) {
    Grammar& g = *grammar_;
    g.uri = context_.uri;
    g.base = root.Get("xml:base", context_.base);
    g.language = root.Get("xml:lang", context_.language);
    g.tag_format = root.Get("tag-format");
    g.root = root.Get("root");
    if (g.root.starts_with("#")) g.root.erase(0, 1);
    const std::string version = root.Get("version", "1.0");
    if (version != "1.0") {
      return Bad(root, "grammar version '" + version + "', expected 1.0");
    }
    const std::string mode = root.Get("mode", context_.mode == Mode::kDtmf ? "dtmf" : "voice");
    if (mode != "voice" && mode != "dtmf") {
      return Bad(root, "mode '" + mode + "', expected voice or dtmf");
    }
    g.mode = mode == "dtmf" ? Mode::kDtmf : Mode::kVoice;
    return {};
  }

  vm::Result<void> TopLevel(const Node& child, Expansion& loose) {
    if (child.IsText()) {
      if (xml::IsBlank(child.text)) return {};
      if (!AddTokens(child.text, loose)) return Bad(child, "a quotation mark without end");
      return {};
    }
    if (!child.IsElement()) return {};
    const std::string& name = child.name;
    if (name == "meta" || name == "metadata" || name == "lexicon") return HeaderElement(child);
    if (name == "rule") return AddRule(child);
    if (name == "tag") {
      grammar_->header_tags.push_back(child.Text());
      return {};
    }
    auto part = Expand(child, 1);  // the original's shortcut
    if (!part) return std::unexpected(part.error());
    if (*part) loose.children.push_back(std::move(*part));
    return {};
  }

  /// meta, metadata, lexicon: nothing of them is used, but they have to be right.
  vm::Result<void> HeaderElement(const Node& node) {
    if (!grammar_->rules.empty()) return Bad(node, "<" + node.name + "> after a <rule>");
    if (node.name == "lexicon" && !node.Has("uri")) return Bad(node, "<lexicon> without uri");
    if (node.name == "meta") {
      if (node.Has("name") == node.Has("http-equiv")) {
        return Bad(node, "<meta> needs either name or http-equiv");
      }
      if (!node.Has("content")) return Bad(node, "<meta> without content");
    }
    return {};
  }

  vm::Result<void> AddRule(const Node& node) {
    auto rule = std::make_unique<Rule>();
    rule->name = node.Get("id");
    rule->line = node.line;
    rule->column = node.column;
    rule->grammar = grammar_.get();
    if (rule->name.starts_with("#")) rule->name.erase(0, 1);
    if (rule->name.empty()) return Bad(node, "<rule> without id");
    if (!IsRuleName(rule->name)) {
      return Bad(node, "'" + rule->name + "' is no name of a rule");
    }
    if (IsSpecial(rule->name)) {
      return Bad(node, "'" + rule->name + "' is a special rule and cannot be defined");
    }
    const std::string scope = node.Get("scope", "private");
    if (scope != "public" && scope != "private") {
      return Bad(node, "scope '" + scope + "', expected public or private");
    }
    rule->is_public = scope == "public";
    if (grammar_->rules.contains(rule->name)) {
      return Bad(node, "rule '" + rule->name + "' is defined twice");
    }
    auto expansion = Sequence(node, 1);
    if (!expansion) return std::unexpected(expansion.error());
    if ((*expansion)->children.empty()) {
      return Bad(node, "rule '" + rule->name + "' is empty");
    }
    rule->expansion = std::move(*expansion);
    if (first_rule_.empty()) first_rule_ = rule->name;
    const std::string name = rule->name;
    grammar_->rules.emplace(name, std::move(rule));
    return {};
  }

  vm::Result<void> Close(const Node& root, std::unique_ptr<Expansion> loose) {
    Grammar& g = *grammar_;
    if (!loose->children.empty()) {
      if (!g.rules.empty()) return Bad(root, "tokens outside of the grammar's rules");
      auto rule = std::make_unique<Rule>();
      rule->name = g.root.empty() ? "main" : g.root;
      rule->is_public = true;
      rule->grammar = grammar_.get();
      rule->line = root.line;
      rule->expansion = std::move(loose);
      g.root = rule->name;
      g.rules.emplace(g.root, std::move(rule));
    }
    if (!g.root.empty() && !g.Find(g.root)) {
      return Bad(root, "root rule '" + g.root + "' is not defined");
    }
    // One rule alone needs no naming; otherwise a grammar without root can only be referred into.
    if (g.root.empty() && g.rules.size() == 1) g.root = first_rule_;
    return {};
  }

  Made Sequence(const Node& node, std::size_t depth) {
    auto sequence = std::make_unique<Expansion>();
    sequence->kind = Kind::kSequence;
    for (const auto& child : node.children) {
      if (child->IsText()) {
        if (!AddTokens(child->text, *sequence)) return Bad(*child, "a quotation mark without end");
        continue;
      }
      if (!child->IsElement()) continue;
      if (child->name == "example" && node.name == "rule") continue;
      auto part = Expand(*child, depth + 1);
      if (!part) return part;
      if (*part) sequence->children.push_back(std::move(*part));
    }
    return sequence;
  }

  /// Text: tokens between blanks; "several words" in quotes are one token. False: a quotation mark
  /// has no partner.
  bool AddTokens(std::string_view text, Expansion& into) const {
    while (!xml::IsBlank(text)) {
      text.remove_prefix(text.find_first_not_of(" \t\r\n"));
      std::size_t end = 0;
      if (text[0] == '"') {
        end = text.find('"', 1);
        if (end == std::string_view::npos) return false;
        into.children.push_back(MakeToken(text.substr(1, end - 1)));
        text.remove_prefix(end + 1);
        continue;
      }
      end = std::min(text.find_first_of(" \t\r\n\""), text.size());
      into.children.push_back(MakeToken(text.substr(0, end)));
      text.remove_prefix(end);
    }
    return true;
  }

  Made Expand(const Node& node, std::size_t depth) {
    if (depth > kMaxGrammarDepth) {
      return Bad(node, "nested deeper than " + std::to_string(kMaxGrammarDepth), vm::Errc::kLimit);
    }
    const std::string& name = node.name;
    if (name == "token") return Token(node);
    if (name == "ruleref") return Reference(node);
    if (name == "item") return Item(node, depth);
    if (name == "one-of") return OneOf(node, depth);
    if (name == "tag") {
      auto tag = std::make_unique<Expansion>();
      tag->kind = Kind::kTag;
      tag->text = node.Text();
      tag->line = node.line;
      return tag;
    }
    return Bad(node, "<" + name + "> is not part of a grammar here");
  }

  Made Token(const Node& node) {
    std::string text = node.Text();
    const std::size_t first = text.find_first_not_of(" \t\r\n");
    if (first != std::string::npos && text[first] == '"') std::erase(text, '"');
    auto token = MakeToken(text);
    token->language = node.Get("xml:lang");
    token->phoneme = node.Get("phoneme");
    token->sym = node.Get("sym");
    if (token->text.empty()) token->text = token->sym;
    if (token->text.empty()) return Bad(node, "<token> without content");
    if (token->folded.empty()) token->folded = Fold(token->text);
    return token;
  }

  Made Reference(const Node& node) {
    auto reference = std::make_unique<Expansion>();
    reference->line = node.line;
    reference->column = node.column;
    const std::string* uri = node.Find("uri");
    const std::string* special = node.Find("special");
    if ((uri == nullptr) == (special == nullptr)) {
      return Bad(node, "<ruleref> needs either uri or special");
    }
    if (special) {
      if (!IsSpecial(*special)) {
        return Bad(node, "special '" + *special + "', expected NULL, VOID or GARBAGE");
      }
      reference->kind = *special == "NULL"   ? Kind::kNull
                        : *special == "VOID" ? Kind::kVoid
                                             : Kind::kGarbage;
      return reference;
    }
    if (uri->empty() || *uri == "#") return Bad(node, "<ruleref> with an empty uri");
    reference->kind = Kind::kReference;
    reference->type = node.Get("type");
    SplitReference(*uri, *reference);
    return reference;
  }

  Made Item(const Node& node, std::size_t depth) {
    auto inner = Sequence(node, depth);
    if (!inner) return inner;
    const std::string* repeat = node.Find("repeat");
    if (const std::string* probability = node.Find("repeat-prob")) {
      double value = 0;
      if (!ParseWeight(*probability, value) || value > 1) {
        return Bad(node, "repeat-prob '" + *probability + "', expected 0.0 to 1.0");
      }
    }
    if (!repeat) return inner;
    auto outer = std::make_unique<Expansion>();
    outer->kind = Kind::kRepeat;
    if (!ParseRepeat(*repeat, outer->min, outer->max)) {
      return Bad(node, "repeat '" + *repeat + "', expected N, N-M or N-");
    }
    outer->children.push_back(std::move(*inner));
    return outer;
  }

  Made OneOf(const Node& node, std::size_t depth) {
    auto choice = std::make_unique<Expansion>();
    choice->kind = Kind::kAlternatives;
    for (const auto& child : node.children) {
      if (child->IsText() && !xml::IsBlank(child->text)) {
        return Bad(*child, "text in <one-of>, expected <item>");
      }
      if (!child->IsElement()) continue;
      if (child->name != "item") {
        return Bad(*child, "<" + child->name + "> in <one-of>, expected <item>");
      }
      double weight = 1;
      if (const std::string* given = child->Find("weight")) {
        if (!ParseWeight(*given, weight) || weight <= 0) {
          return Bad(*child, "weight '" + *given + "', expected a number above 0");
        }
      }
      auto item = Item(*child, depth + 1);
      if (!item) return item;
      choice->children.push_back(std::move(*item));
      choice->weights.push_back(weight);
    }
    if (choice->children.empty()) return Bad(node, "<one-of> without <item>");
    return choice;
  }

  const GrammarContext& context_;
  std::unique_ptr<Grammar> grammar_;
  std::string first_rule_;
};

}  // namespace

vm::Result<std::unique_ptr<Grammar>> CompileXml(const xml::Node& grammar,
                                                const GrammarContext& context) {
  return XmlCompiler(context).Run(grammar);
}

}  // namespace vxml::srgs
