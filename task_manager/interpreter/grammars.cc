#include "task_manager/document/schema.h"
#include "task_manager/fetch/uri.h"
#include "task_manager/grammar/builtin.h"
#include "task_manager/interpreter/choice_keys.h"
#include "task_manager/interpreter/session.h"

namespace vxml {

using srgs::Mode;

/// In order of precedence (VoiceXML 2.0 section 3.1.4): the item's own, its dialog's, its
/// document's, the application root's, the platform's.
std::vector<ActiveGrammar> Session::ActiveGrammars(const Item& item, bool modal) {
  std::vector<ActiveGrammar> active;
  AddItemGrammars(item, active);
  if (modal) return active;
  AddDialogGrammars(*dialog_->node, *context_->document, false, active);
  const auto add_document = [&](const Document& document) {
    AddLinks(*document.root, document, active);
    for (const xml::Node* dialog : document.dialogs) {
      if (dialog != dialog_->node) AddDialogGrammars(*dialog, document, true, active);
    }
  };
  add_document(*context_->document);
  if (context_->root != context_->document) add_document(*context_->root);
  AddUniversals(active);
  return active;
}

void Session::AddItemGrammars(const Item& item, std::vector<ActiveGrammar>& active) {
  if (item.kind == ItemKind::kMenu || item.kind == ItemKind::kInitial) {
    AddLinks(*item.node, *context_->document, active);
    return;
  }
  const Document& document = *context_->document;
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
void Session::AddDialogGrammars(const xml::Node& dialog, const Document& document,
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

void Session::AddLinks(const xml::Node& parent, const Document& document,
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

void Session::AddGrammar(const xml::Node& grammar, const Document& document, Match::Owner owner,
                         const xml::Node& target, std::vector<ActiveGrammar>& active) {
  if (const srgs::Rule* rule = CompileGrammar(grammar, document)) {
    active.push_back({rule, owner, &target, &document});
  }
}

namespace {

/// The text of a choice or option without what belongs to its grammar.
std::string PhraseOf(const xml::Node& node) {
  std::string text;
  for (const auto& child : node.children) {
    if (child->IsElement("grammar")) continue;
    text += child->IsText() ? child->text : child->IsElement() ? " " + child->Text() + " " : "";
  }
  return xml::Collapse(text);
}

}  // namespace

std::map<const xml::Node*, std::string> ChoiceKeys(const xml::Node& menu) {
  std::map<const xml::Node*, std::string> keys;
  const bool numbered = menu.Get("dtmf", "false") == "true";
  int number = 0;
  for (const auto& child : menu.children) {
    if (!child->IsElement("choice")) continue;
    if (const std::string* own = child->Find("dtmf")) {
      keys[child.get()] = *own;
    } else if (numbered && number < 9) {
      keys[child.get()] = std::to_string(++number);
    }
  }
  return keys;
}

void Session::AddChoices(const xml::Node& menu, const Document& document,
                         std::vector<ActiveGrammar>& active) {
  const auto keys = ChoiceKeys(menu);
  for (const auto& child : menu.children) {
    if (!child->IsElement("choice")) continue;
    bool has_grammar = false;
    for (const auto& inner : child->children) {
      if (!inner->IsElement("grammar")) continue;
      has_grammar = true;
      AddGrammar(*inner, document, Match::Owner::kChoice, *child, active);
    }
    const std::string phrase = PhraseOf(*child);
    const bool approximate = child->Get("accept", menu.Get("accept", "exact")) == "approximate";
    if (!has_grammar && !phrase.empty()) {
      const std::string key = std::string(approximate ? "approx " : "exact ") + phrase;
      active.push_back({MakePhrase(key, phrase, approximate, false, "", false),
                        Match::Owner::kChoice, child.get(), &document});
    }
    if (const auto own = keys.find(child.get()); own != keys.end() && !own->second.empty()) {
      active.push_back({MakePhrase("dtmf " + own->second, own->second, false, true, "", false),
                        Match::Owner::kChoice, child.get(), &document});
    }
  }
}

void Session::AddOptions(const xml::Node& field, const Document& document,
                         std::vector<ActiveGrammar>& active) {
  for (const auto& child : field.children) {
    if (!child->IsElement("option")) continue;
    const std::string phrase = PhraseOf(*child);
    const std::string keys = child->Get("dtmf");
    const std::string value = child->Get("value", phrase.empty() ? keys : phrase);
    const bool approximate = child->Get("accept", "exact") == "approximate";
    if (!phrase.empty()) {
      const std::string key =
          std::string(approximate ? "approx " : "exact ") + phrase + " => " + value;
      active.push_back({MakePhrase(key, phrase, approximate, false, value, true),
                        Match::Owner::kItem, &field, &document});
    }
    if (!keys.empty()) {
      active.push_back({MakePhrase("dtmf " + keys + " => " + value, keys, false, true, value, true),
                        Match::Owner::kItem, &field, &document});
    }
  }
}

/// help, cancel and exit as words of the platform (property universals).
void Session::AddUniversals(std::vector<ActiveGrammar>& active) {
  const std::string wanted = Property("universals");
  for (const char* word : {"help", "cancel", "exit"}) {
    bool on = false;
    for (const std::string_view name : SplitWords(wanted)) on = on || name == "all" || name == word;
    if (!on) continue;
    active.push_back({MakePhrase(std::string("exact ") + word, word, false, false, "", false),
                      Match::Owner::kUniversal, nullptr, nullptr});
  }
}

void Session::AddBuiltin(const std::string& name, const xml::Node& node, const Document& document,
                         std::vector<ActiveGrammar>& active) {
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

const srgs::Rule* Session::CompileGrammar(const xml::Node& node, const Document& document) {
  const std::string type = node.Get("type");
  static constexpr std::string_view kTypes =
      "application/srgs+xml application/srgs application/grammar+xml application/grammar text/xml "
      "application/xml application/x-abnf";
  const auto known = SplitWords(kTypes);
  if (!type.empty() && std::find(known.begin(), known.end(),
                                 std::string_view(type).substr(0, type.find(';'))) == known.end()) {
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
    const std::string text(xml::Trim(node.Text()));
    const bool abnf =
        !elements &&
        (text.starts_with("#ABNF") || type == "application/srgs" || type == "application/x-abnf" ||
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

const srgs::Rule* Session::CompileExternal(const xml::Node& node, const Document& document,
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

/// A grammar of one phrase (or of its parts, in order), or of keys.
const srgs::Rule* Session::MakePhrase(const std::string& key, const std::string& text,
                                      bool approximate, bool dtmf, const std::string& value,
                                      bool has_value) {
  if (const auto found = phrases_.find(key); found != phrases_.end()) return found->second;
  auto grammar = std::make_unique<srgs::Grammar>();
  grammar->uri = "platform:" + key;
  grammar->mode = dtmf ? Mode::kDtmf : Mode::kVoice;
  grammar->root = "phrase";
  grammar->tag_format = "semantics/1.0-literals";
  auto rule = std::make_unique<srgs::Rule>();
  rule->name = "phrase";
  rule->grammar = grammar.get();
  rule->is_public = true;
  rule->expansion = std::make_unique<srgs::Expansion>();
  auto& parts = rule->expansion->children;
  if (dtmf) {
    for (const char c : text) {
      if (c != ' ' && c != '\t') parts.push_back(srgs::MakeToken(std::string(1, c)));
    }
  } else {
    for (const std::string_view word : SplitWords(text)) parts.push_back(srgs::MakeToken(word));
  }
  if (approximate && parts.size() > 1) {  // any words of it, in order, at least one
    auto choice = std::make_unique<srgs::Expansion>();
    choice->kind = srgs::Expansion::Kind::kAlternatives;
    for (std::size_t first = 0; first < parts.size(); ++first) {
      auto sequence = std::make_unique<srgs::Expansion>();
      sequence->children.push_back(srgs::MakeToken(parts[first]->text));
      for (std::size_t next = first + 1; next < parts.size(); ++next) {
        auto optional = std::make_unique<srgs::Expansion>();
        optional->kind = srgs::Expansion::Kind::kRepeat;
        optional->min = 0;
        optional->children.push_back(srgs::MakeToken(parts[next]->text));
        sequence->children.push_back(std::move(optional));
      }
      choice->children.push_back(std::move(sequence));
    }
    parts.clear();
    parts.push_back(std::move(choice));
  }
  if (has_value) {
    auto tag = std::make_unique<srgs::Expansion>();
    tag->kind = srgs::Expansion::Kind::kTag;
    tag->text = value;
    parts.push_back(std::move(tag));
  }
  grammar->rules.emplace("phrase", std::move(rule));
  auto added = grammars_->Add(std::move(grammar));
  if (!added) ThrowEvent("error.semantic", added.error().text);
  phrases_[key] = (*added)->RootRule();
  return phrases_[key];
}

}  // namespace vxml
