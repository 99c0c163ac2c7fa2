#include "task_manager/grammar/compiler.h"
#include "task_manager/grammar/xml_rules.h"

namespace vxml::srgs {
namespace {

using vm::xml::Node;

class XmlCompiler {
 public:
  XmlCompiler(const GrammarContext& context, const std::string& space)
      : context_(context), rules_(context, space) {}

  vm::Result<std::unique_ptr<Grammar>> Run(const Node& root) {
    grammar_ = MakeGrammar(context_);
    if (auto done = Header(root); !done) return std::unexpected(done.error());
    auto loose = std::make_unique<Expansion>();
    for (const auto& child : root.children) {
      if (auto done = TopLevel(*child, *loose); !done) return std::unexpected(done.error());
    }
    if (auto done = CheckTokens(*grammar_); !done) return rules_.Bad(root, done.error().text);
    if (auto done = Close(root, std::move(loose)); !done) return std::unexpected(done.error());
    return std::move(grammar_);
  }

 private:
  vm::Result<void> Header(const Node& root) {
    Grammar& g = *grammar_;
    g.base = root.Get("xml:base", context_.base);
    g.language = root.Get("xml:lang", g.language);
    g.tag_format = root.Get("tag-format");
    g.root = root.Get("root");
    if (!context_.alone && g.root.starts_with("#")) g.root.erase(0, 1);
    const std::string version = root.Get("version", context_.alone ? "" : "1.0");
    if (version != "1.0") {
      return rules_.Bad(root, "grammar version '" + version + "', expected 1.0");
    }
    if (context_.alone && root.space != kSrgsSpace) {
      return rules_.Bad(root, "<grammar> of the namespace '" + root.space + "', expected " +
                                  std::string(kSrgsSpace));
    }
    if (root.Has("xml:lang") && !IsLanguage(g.language)) {
      return rules_.Bad(root, "xml:lang '" + g.language + "' is no language");
    }
    const std::string mode = root.Get("mode", g.mode == Mode::kDtmf ? "dtmf" : "voice");
    if (mode != "voice" && mode != "dtmf") {
      return rules_.Bad(root, "mode '" + mode + "', expected voice or dtmf");
    }
    g.mode = mode == "dtmf" ? Mode::kDtmf : Mode::kVoice;
    return {};
  }

  vm::Result<void> TopLevel(const Node& child, Expansion& loose) {
    if (child.IsText()) {
      if (vm::xml::IsBlank(child.text)) return {};
      if (context_.alone) return rules_.Bad(child, "text in <grammar>");
      if (!rules_.AddTokens(child.text, loose))
        return rules_.Bad(child, "a quotation mark without end");
      return {};
    }
    if (!child.IsElement() || rules_.IsForeign(child)) return {};
    const std::string& name = child.name;
    if (name == "meta" || name == "metadata" || name == "lexicon") return HeaderElement(child);
    if (name == "rule") return AddRule(child);
    if (name == "tag") {
      if (!grammar_->rules.empty()) return rules_.Bad(child, "<tag> after a <rule>");
      if (auto done = rules_.CheckContent(child, true); !done) return done;
      grammar_->header_tags.push_back(child.Text());
      return {};
    }
    if (context_.alone) return rules_.Bad(child, "<" + name + "> in <grammar>, expected <rule>");
    auto part = rules_.Expand(child, 1);  // the original's shortcut
    if (!part) return std::unexpected(part.error());
    if (*part) loose.children.push_back(std::move(*part));
    return {};
  }

  /// meta, metadata, lexicon: nothing of them is used, but they have to be right.
  vm::Result<void> HeaderElement(const Node& node) {
    if (!grammar_->rules.empty()) return rules_.Bad(node, "<" + node.name + "> after a <rule>");
    if (node.name == "metadata") return {};
    if (auto done = rules_.CheckContent(node, false); !done) return done;
    if (node.name == "lexicon" && !node.Has("uri"))
      return rules_.Bad(node, "<lexicon> without uri");
    if (node.name == "meta") {
      if (node.Has("name") == node.Has("http-equiv")) {
        return rules_.Bad(node, "<meta> needs either name or http-equiv");
      }
      if (!node.Has("content")) return rules_.Bad(node, "<meta> without content");
    }
    return {};
  }

  vm::Result<void> AddRule(const Node& node) {
    auto rule = std::make_unique<Rule>();
    rule->name = node.Get("id");
    rule->line = node.line;
    rule->column = node.column;
    rule->grammar = grammar_.get();
    if (!context_.alone && rule->name.starts_with("#")) rule->name.erase(0, 1);
    if (rule->name.empty()) return rules_.Bad(node, "<rule> without id");
    if (!IsRuleName(rule->name)) {
      return rules_.Bad(node, "'" + rule->name + "' is no name of a rule");
    }
    if (IsSpecialRule(rule->name)) {
      return rules_.Bad(node, "'" + rule->name + "' is a special rule and cannot be defined");
    }
    const std::string scope = node.Get("scope", "private");
    if (scope != "public" && scope != "private") {
      return rules_.Bad(node, "scope '" + scope + "', expected public or private");
    }
    rule->is_public = scope == "public";
    if (grammar_->rules.contains(rule->name)) {
      return rules_.Bad(node, "rule '" + rule->name + "' is defined twice");
    }
    auto expansion = rules_.Sequence(node, 1);
    if (!expansion) return std::unexpected(expansion.error());
    if ((*expansion)->children.empty()) {
      return rules_.Bad(node, "rule '" + rule->name + "' is empty");
    }
    rule->expansion = std::move(*expansion);
    const std::string name = rule->name;
    grammar_->rules.emplace(name, std::move(rule));
    return {};
  }

  vm::Result<void> Close(const Node& root, std::unique_ptr<Expansion> loose) {
    Grammar& g = *grammar_;
    if (!loose->children.empty()) {
      if (!g.rules.empty()) return rules_.Bad(root, "tokens outside of the grammar's rules");
      auto rule = std::make_unique<Rule>();
      rule->name = g.root.empty() ? "main" : g.root;
      rule->is_public = true;
      rule->grammar = grammar_.get();
      rule->line = root.line;
      rule->expansion = std::move(loose);
      g.root = rule->name;
      g.rules.emplace(g.root, std::move(rule));
    }
    if (auto done = CheckHeader(g, context_); !done) return rules_.Bad(root, done.error().text);
    return {};
  }

  const GrammarContext& context_;
  XmlRules rules_;
  std::unique_ptr<Grammar> grammar_;
};

}  // namespace

vm::Result<std::unique_ptr<Grammar>> CompileXml(const vm::xml::Node& grammar,
                                                const GrammarContext& context) {
  return XmlCompiler(context, grammar.space).Run(grammar);
}

}  // namespace vxml::srgs
