#include "task_manager/interpreter/grammar_set.h"

#include <algorithm>

#include "task_manager/grammar/builtin.h"

namespace vxml {

using srgs::Mode;

namespace {

Mode ModeOf(const vm::xml::Node& grammar) {
  return grammar.Get("mode") == "dtmf" ? Mode::kDtmf : Mode::kVoice;
}

/// An inline grammar in ABNF: it says so by its header or type, or has rules of that form.
bool IsAbnf(const vm::xml::Node& grammar, const std::string& text) {
  if (std::ranges::any_of(grammar.children, [](const auto& it) { return it->IsElement(); })) {
    return false;
  }
  return text.starts_with("#ABNF") || srgs::FormOfType(grammar.Get("type")) == srgs::Form::kAbnf ||
         (text.find('$') != std::string::npos && text.find(';') != std::string::npos);
}

}  // namespace

GrammarSet::GrammarSet(Runtime& runtime, DocumentSet& documents)
    : rt_(runtime), store_([this, &documents](const std::string& uri) -> vm::Result<std::string> {
        fetch::Request request = documents.RequestFor(rt_.position.Here(), "grammar");
        request.uri = uri;
        request.from.clear();  // the store has judged who asks
        auto got = documents.FetchSilently(request, "grammar");
        if (!got) return std::unexpected(static_cast<vm::Error>(got.error()));
        return std::move(got->body);
      }) {}

const srgs::Grammar& GrammarSet::Add(std::unique_ptr<srgs::Grammar> grammar, const char* event) {
  auto added = store_.Add(std::move(grammar));
  if (!added) ThrowEvent(event, added.error().text);
  return **added;
}

const srgs::Rule* GrammarSet::Compile(const vm::xml::Node& grammar, const VxmlDocument& document) {
  rt_.budget.Step(0);
  const std::string type = grammar.Get("type");
  if (!type.empty() && !srgs::FormOfType(type)) {
    ThrowEvent("error.unsupported.format", "grammars of type '" + type + "' are not known");
  }
  if (const std::string* expression = grammar.Find("srcexpr")) {
    return CompileExternal(grammar, document, rt_.scopes.Text(grammar, *expression));
  }
  if (const auto found = of_elements_.find(&grammar); found != of_elements_.end()) {
    return found->second;
  }
  const std::string* source = grammar.Find("src");
  const srgs::Rule* rule =
      source ? CompileExternal(grammar, document, *source) : CompileInline(grammar, document);
  of_elements_[&grammar] = rule;
  return rule;
}

const srgs::Rule* GrammarSet::CompileInline(const vm::xml::Node& grammar,
                                            const VxmlDocument& document) {
  srgs::GrammarContext context;
  context.uri = document.uri;
  context.base = document.base;
  context.language = rt_.position.LanguageAt(grammar);
  context.mode = ModeOf(grammar);
  const std::string text(vm::xml::Trim(grammar.Text()));
  auto made =
      IsAbnf(grammar, text) ? srgs::CompileAbnf(text, context) : srgs::CompileXml(grammar, context);
  if (!made) ThrowEvent("error.badfetch", made.error().text);
  if ((*made)->mode == Mode::kVoice) rt_.RequireLanguage((*made)->language);
  const srgs::Rule* rule = Add(std::move(*made), "error.badfetch").RootRule();
  if (!rule) {
    ThrowEvent("error.badfetch", document.uri + ":" + std::to_string(grammar.line) +
                                     ": a grammar of several rules needs a root");
  }
  return rule;
}

const srgs::Rule* GrammarSet::CompileExternal(const vm::xml::Node& grammar,
                                              const VxmlDocument& document,
                                              const std::string& reference) {
  if (reference.starts_with("builtin:")) {
    const std::string name = reference.substr(8);
    const std::size_t slash = name.find('/');
    return Builtin(slash == std::string::npos ? name : name.substr(slash + 1), grammar,
                   name.starts_with("dtmf/") ? Mode::kDtmf : Mode::kVoice);
  }
  srgs::GrammarContext context;
  context.uri = rt_.position.OriginOf(grammar).uri;
  context.language = rt_.position.LanguageAt(grammar);
  context.mode = ModeOf(grammar);
  const std::string base = grammar.Inherited("xml:base");
  const std::string uri =
      fetch::Resolve(base.empty() ? document.base : fetch::Resolve(document.base, base), reference);
  const srgs::Rule* rule = nullptr;
  auto loaded = store_.Load(uri, context, &rule);
  if (!loaded) {
    const bool denied = loaded.error().code == vm::Errc::kAccess;
    ThrowEvent(denied ? "error.noauthorization" : "error.badfetch", loaded.error().text);
  }
  if (grammar.Has("mode") && rule->grammar->mode != context.mode) {
    ThrowEvent("error.badfetch", uri + ": the grammar is not of mode " + grammar.Get("mode"));
  }
  if (rule->grammar->mode == Mode::kVoice) rt_.RequireLanguage(rule->grammar->language);
  return rule;
}

const srgs::Rule* GrammarSet::Compile(const Phrase& phrase) {
  auto& rule = of_phrases_[phrase.Key()];
  if (!rule) rule = Add(MakeGrammar(phrase), "error.semantic").RootRule();
  return rule;
}

const srgs::Rule* GrammarSet::Builtin(const std::string& type, const vm::xml::Node& node,
                                      Mode mode) {
  const std::string language = rt_.position.LanguageAt(node);
  auto& rule = of_types_[type + (mode == Mode::kDtmf ? " dtmf" : " " + language)];
  if (rule) return rule;
  auto made = srgs::MakeBuiltin(srgs::ParseBuiltin(type), mode, language);
  if (!made) {
    const bool known = srgs::IsBuiltinType(srgs::ParseBuiltin(type).type);
    ThrowEvent(made.error().code != vm::Errc::kUnavailable ? "error.badfetch"
               : known                                     ? "error.unsupported.language"
                                                           : "error.unsupported.builtin",
               made.error().text);
  }
  return rule = Add(std::move(*made), "error.badfetch").RootRule();
}

}  // namespace vxml
