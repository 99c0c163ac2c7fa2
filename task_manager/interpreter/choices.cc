#include "task_manager/interpreter/choices.h"

namespace vxml {
namespace {

std::string PhraseOf(const vm::xml::Node& node) {
  std::string text;
  for (const auto& child : node.children) {
    if (child->IsElement("grammar")) continue;
    text += child->IsText() ? child->text : child->IsElement() ? " " + child->Text() + " " : "";
  }
  return vm::xml::Collapse(text);
}

}  // namespace

std::vector<Choice> ChoicesOf(const vm::xml::Node& menu_or_field) {
  const bool menu = menu_or_field.name == "menu";
  const bool numbered = menu && menu_or_field.Get("dtmf", "false") == "true";
  std::vector<Choice> choices;
  int number = 0;
  for (const auto& child : menu_or_field.children) {
    if (!child->IsElement(menu ? "choice" : "option")) continue;
    Choice choice{child.get(), PhraseOf(*child), child->Get("dtmf")};
    if (numbered && number < 9 && !child->Has("dtmf")) choice.keys = std::to_string(++number);
    choices.push_back(std::move(choice));
  }
  return choices;
}

}  // namespace vxml
