// Grammars nobody wrote out: of choices, options, keys and the platform's own words.
#include "task_manager/document/schema.h"
#include "task_manager/interpreter/choice_keys.h"
#include "task_manager/interpreter/dialog_session.h"

namespace vxml {
namespace {

/// The text of a choice or option without what belongs to its grammar.
std::string PhraseOf(const vm::xml::Node& node) {
  std::string text;
  for (const auto& child : node.children) {
    if (child->IsElement("grammar")) continue;
    text += child->IsText() ? child->text : child->IsElement() ? " " + child->Text() + " " : "";
  }
  return vm::xml::Collapse(text);
}

}  // namespace

std::map<const vm::xml::Node*, std::string> ChoiceKeys(const vm::xml::Node& menu) {
  std::map<const vm::xml::Node*, std::string> keys;
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

void DialogSession::AddChoices(const vm::xml::Node& menu, const VxmlDocument& document,
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

void DialogSession::AddOptions(const vm::xml::Node& field, const VxmlDocument& document,
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
void DialogSession::AddUniversals(std::vector<ActiveGrammar>& active) {
  const std::string wanted = Property("universals");
  for (const char* word : {"help", "cancel", "exit"}) {
    bool on = false;
    for (const std::string_view name : SplitWords(wanted)) on = on || name == "all" || name == word;
    if (!on) continue;
    active.push_back({MakePhrase(std::string("exact ") + word, word, false, false, "", false),
                      Match::Owner::kUniversal, nullptr, nullptr});
  }
}

/// A grammar of one phrase (or of its parts, in order), or of keys.
const srgs::Rule* DialogSession::MakePhrase(const std::string& key, const std::string& text,
                                            bool approximate, bool dtmf, const std::string& value,
                                            bool has_value) {
  if (const auto found = phrases_.find(key); found != phrases_.end()) return found->second;
  auto grammar = std::make_unique<srgs::Grammar>();
  grammar->uri = "platform:" + key;
  grammar->mode = dtmf ? srgs::Mode::kDtmf : srgs::Mode::kVoice;
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
