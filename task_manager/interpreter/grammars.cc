#include "task_manager/document/schema.h"
#include "task_manager/fetch/uri.h"
#include "task_manager/grammar/builtin.h"
#include "task_manager/interpreter/dialog_session.h"

namespace vxml {

using srgs::Mode;

/// In order of precedence (VoiceXML 2.0 section 3.1.4): the item's own, its dialog's, its
/// document's, the application root's, the platform's.
std::vector<ActiveGrammar> DialogSession::ActiveGrammars(const Item& item, bool modal) {
  std::vector<ActiveGrammar> active;
  AddItemGrammars(item, active);
  if (modal) return active;
  AddDialogGrammars(*dialog_->node, *context_->document, false, active);
  const auto add_document = [&](const VxmlDocument& document) {
    AddLinks(*document.root, document, active);
    for (const vm::xml::Node* dialog : document.dialogs) {
      if (dialog != dialog_->node) AddDialogGrammars(*dialog, document, true, active);
    }
  };
  add_document(*context_->document);
  if (context_->root != context_->document) add_document(*context_->root);
  AddUniversals(active);
  return active;
}

void DialogSession::AddItemGrammars(const Item& item, std::vector<ActiveGrammar>& active) {
  if (item.kind == ItemKind::kMenu || item.kind == ItemKind::kInitial) {
    AddLinks(*item.node, *context_->document, active);
    return;
  }
  const VxmlDocument& document = *context_->document;
  for (const auto& child : item.node->children) {
    if (child->IsElement("grammar")) {
      AddGrammar(*child, document, Match::Owner::kItem, *item.node, active);
    }
  }
  if (item.kind == ItemKind::kField) {
    if (const std::string* type = item.node->Find("type")) {
      AddBuiltin(*type, *item.node, document, active);
    }
    AddOptions(*item.node, document, active);
  }
  AddLinks(*item.node, document, active);
}

/// A form's or menu's own grammars; of other dialogs only those with document scope.
void DialogSession::AddDialogGrammars(const vm::xml::Node& dialog, const VxmlDocument& document,
                                      bool only_document, std::vector<ActiveGrammar>& active) {
  const bool wide = dialog.Get("scope") == "document";
  if (dialog.name == "menu") {
    if (wide || !only_document) AddChoices(dialog, document, active);
    return;
  }
  for (const auto& child : dialog.children) {
    if (!child->IsElement("grammar")) continue;
    const bool reaches = child->Has("scope") ? child->Get("scope") == "document" : wide;
    if (reaches || !only_document) {
      AddGrammar(*child, document, Match::Owner::kForm, dialog, active);
    }
  }
  if (!only_document) AddLinks(dialog, document, active);
}

void DialogSession::AddLinks(const vm::xml::Node& parent, const VxmlDocument& document,
                             std::vector<ActiveGrammar>& active) {
  for (const auto& child : parent.children) {
    if (!child->IsElement("link")) continue;
    for (const auto& inner : child->children) {
      if (inner->IsElement("grammar")) {
        AddGrammar(*inner, document, Match::Owner::kLink, *child, active);
      }
    }
    const std::string keys = child->Get("dtmf");
    if (keys.empty()) continue;
    const srgs::Rule* rule = MakePhrase("dtmf " + keys, keys, false, true, "", false);
    active.push_back({rule, Match::Owner::kLink, child.get(), &document});
  }
}

void DialogSession::AddGrammar(const vm::xml::Node& grammar, const VxmlDocument& document,
                               Match::Owner owner, const vm::xml::Node& target,
                               std::vector<ActiveGrammar>& active) {
  if (const srgs::Rule* rule = CompileGrammar(grammar, document)) {
    active.push_back({rule, owner, &target, &document});
  }
}

void DialogSession::AddBuiltin(const std::string& name, const vm::xml::Node& node,
                               const VxmlDocument& document, std::vector<ActiveGrammar>& active) {
  const std::string language = LanguageAt(node);
  for (const Mode mode : {Mode::kVoice, Mode::kDtmf}) {
    const std::string key = "builtin " + name + (mode == Mode::kDtmf ? " dtmf" : " " + language);
    auto found = phrases_.find(key);
    if (found == phrases_.end()) {
      auto made = srgs::MakeBuiltin(srgs::ParseBuiltin(name), mode, language);
      if (!made) {
        const bool unknown = made.error().code == vm::Errc::kUnavailable;
        const bool type = srgs::IsBuiltinType(srgs::ParseBuiltin(name).type);
        ThrowEvent(unknown ? (type ? "error.unsupported.language" : "error.unsupported.builtin")
                           : "error.badfetch",
                   made.error().text);
      }
      auto added = grammars_->Add(std::move(*made));
      if (!added) ThrowEvent("error.badfetch", added.error().text);
      found = phrases_.emplace(key, (*added)->RootRule()).first;
    }
    active.push_back({found->second, Match::Owner::kItem, &node, &document});
  }
}

const srgs::Rule* DialogSession::CompileGrammar(const vm::xml::Node& node,
                                                const VxmlDocument& document) {
  const std::string type = node.Get("type");
  const auto form = srgs::FormOfType(type);
  if (!form && !type.empty()) {
    ThrowEvent("error.unsupported.format", "grammars of type '" + type + "' are not known");
  }
  if (const std::string* expression = node.Find("srcexpr")) {
    return CompileExternal(node, document, TextOf(node, *expression));
  }
  if (const auto found = compiled_.find(&node); found != compiled_.end()) return found->second;
  const srgs::Rule* rule = nullptr;
  if (const std::string* source = node.Find("src")) {
    rule = CompileExternal(node, document, *source);
  } else {
    srgs::GrammarContext context;
    context.uri = document.uri;
    context.base = document.base;
    context.language = LanguageAt(node);
    context.mode = node.Get("mode") == "dtmf" ? Mode::kDtmf : Mode::kVoice;
    bool elements = false;
    for (const auto& child : node.children) elements = elements || child->IsElement();
    const std::string text(vm::xml::Trim(node.Text()));
    const bool abnf =
        !elements && (text.starts_with("#ABNF") || form == srgs::Form::kAbnf ||
                      (text.find('$') != std::string::npos && text.find(';') != std::string::npos));
    auto made = abnf ? srgs::CompileAbnf(text, context) : srgs::CompileXml(node, context);
    if (!made) ThrowEvent("error.badfetch", made.error().text);
    if ((*made)->mode == Mode::kVoice) RequireLanguage((*made)->language);
    auto added = grammars_->Add(std::move(*made));
    if (!added) ThrowEvent("error.badfetch", added.error().text);
    rule = (*added)->RootRule();
    if (!rule) {
      ThrowEvent("error.badfetch", document.uri + ":" + std::to_string(node.line) +
                                       ": a grammar of several rules needs a root");
    }
  }
  compiled_[&node] = rule;
  return rule;
}

const srgs::Rule* DialogSession::CompileExternal(const vm::xml::Node& node,
                                                 const VxmlDocument& document,
                                                 const std::string& reference) {
  if (reference.starts_with("builtin:")) {
    std::string name = reference.substr(8);
    const bool dtmf = name.starts_with("dtmf/");
    if (const std::size_t slash = name.find('/'); slash != std::string::npos) {
      name.erase(0, slash + 1);
    }
    std::vector<ActiveGrammar> both;
    AddBuiltin(name, node, document, both);
    return both[dtmf ? 1 : 0].rule;
  }
  srgs::GrammarContext context;
  context.uri = OriginOf(node).uri;
  context.language = LanguageAt(node);
  context.mode = node.Get("mode") == "dtmf" ? Mode::kDtmf : Mode::kVoice;
  const std::string base = node.Inherited("xml:base");
  const std::string uri =
      fetch::Resolve(base.empty() ? document.base : fetch::Resolve(document.base, base), reference);
  const srgs::Rule* rule = nullptr;
  auto loaded = grammars_->Load(uri, context, &rule);
  if (!loaded) {
    const bool denied = loaded.error().code == vm::Errc::kAccess;
    ThrowEvent(denied ? "error.noauthorization" : "error.badfetch", loaded.error().text);
  }
  if (node.Has("mode") && rule->grammar->mode != context.mode) {
    ThrowEvent("error.badfetch", uri + ": the grammar is not of mode " + node.Get("mode"));
  }
  RequireLanguage(rule->grammar->language);
  return rule;
}

}  // namespace vxml
