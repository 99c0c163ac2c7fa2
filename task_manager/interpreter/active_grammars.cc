#include "task_manager/interpreter/active_grammars.h"

#include <algorithm>

#include "task_manager/document/schema.h"
#include "task_manager/interpreter/choices.h"

namespace vxml {

using Owner = Match::Owner;

std::vector<ActiveGrammar> ActiveGrammars::Of(const FormItem& item, bool modal) {
  document_ = rt_.position.document.get();
  AddItem(item);
  if (modal) return std::move(active_);
  AddDialog(*rt_.position.dialog->node, false);
  AddDocument(*rt_.position.document);
  if (rt_.position.root != rt_.position.document) AddDocument(*rt_.position.root);
  AddUniversals();
  return std::move(active_);
}

void ActiveGrammars::AddItem(const FormItem& item) {
  if (item.kind != ItemKind::kMenu && item.kind != ItemKind::kInitial) {
    AddInside(*item.node, Owner::kItem);
    if (item.kind == ItemKind::kField) {
      if (const std::string* type = item.node->Find("type")) {
        for (const srgs::Mode mode : {srgs::Mode::kVoice, srgs::Mode::kDtmf}) {
          Add(grammars_.Builtin(*type, *item.node, mode), Owner::kItem, item.node);
        }
      }
      AddOptions(*item.node);
    }
  }
  AddLinks(*item.node);
}

void ActiveGrammars::AddDialog(const vm::xml::Node& dialog, bool only_document_scope) {
  if (dialog.name == "menu") return AddChoices(dialog);
  const std::string scope = dialog.Get("scope", "dialog");
  for (const auto& child : dialog.children) {
    if (!child->IsElement("grammar")) continue;
    if (only_document_scope && child->Get("scope", scope) != "document") continue;
    Add(grammars_.Compile(*child, *document_), Owner::kForm, &dialog);
  }
  if (!only_document_scope) AddLinks(dialog);
}

void ActiveGrammars::AddDocument(const VxmlDocument& document) {
  document_ = &document;
  AddLinks(*document.root);
  for (const vm::xml::Node* dialog : document.dialogs_of_document_scope) {
    if (dialog != rt_.position.dialog->node) AddDialog(*dialog, true);
  }
}

bool ActiveGrammars::AddInside(const vm::xml::Node& element, Owner owner) {
  bool any = false;
  for (const auto& child : element.children) {
    if (!child->IsElement("grammar")) continue;
    any = true;
    Add(grammars_.Compile(*child, *document_), owner, &element);
  }
  return any;
}

void ActiveGrammars::AddLinks(const vm::xml::Node& parent) {
  for (const auto& child : parent.children) {
    if (!child->IsElement("link")) continue;
    AddInside(*child, Owner::kLink);
    const std::string keys = child->Get("dtmf");
    if (keys.empty()) continue;
    Add(grammars_.Compile(Phrase{.words = keys, .dtmf = true}), Owner::kLink, child.get());
  }
}

void ActiveGrammars::AddChoices(const vm::xml::Node& menu) {
  const std::string accept = menu.Get("accept", "exact");
  for (const Choice& choice : ChoicesOf(menu)) {
    const bool has_grammar = AddInside(*choice.node, Owner::kChoice);
    if (!has_grammar && !choice.phrase.empty()) {
      const bool approximate = choice.node->Get("accept", accept) == "approximate";
      Add(grammars_.Compile(Phrase{.words = choice.phrase, .approximate = approximate}),
          Owner::kChoice, choice.node);
    }
    if (choice.keys.empty()) continue;
    Add(grammars_.Compile(Phrase{.words = choice.keys, .dtmf = true}), Owner::kChoice, choice.node);
  }
}

void ActiveGrammars::AddOptions(const vm::xml::Node& field) {
  for (const Choice& option : ChoicesOf(field)) {
    const std::string value =
        option.node->Get("value", option.phrase.empty() ? option.keys : option.phrase);
    if (!option.phrase.empty()) {
      const bool approximate = option.node->Get("accept") == "approximate";
      Add(grammars_.Compile(
              Phrase{.words = option.phrase, .approximate = approximate, .value = value}),
          Owner::kItem, &field);
    }
    if (option.keys.empty()) continue;
    Add(grammars_.Compile(Phrase{.words = option.keys, .dtmf = true, .value = value}), Owner::kItem,
        &field);
  }
}

void ActiveGrammars::AddUniversals() {
  const std::string wanted = rt_.properties.Get("universals");
  const auto names = SplitWords(wanted);
  document_ = nullptr;
  for (const char* word : {"help", "cancel", "exit"}) {
    const bool on = std::ranges::any_of(
        names, [&](std::string_view name) { return name == "all" || name == word; });
    if (on)
      Add(grammars_.Compile(Phrase{.words = word, .value = word}), Owner::kUniversal, nullptr);
  }
}

}  // namespace vxml
