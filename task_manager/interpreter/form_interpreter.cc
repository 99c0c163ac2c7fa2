#include "task_manager/interpreter/form_interpreter.h"

#include <algorithm>
#include <map>
#include <optional>
#include <string_view>

namespace vxml {

using script::Value;

namespace {

std::optional<ItemKind> KindOf(const vm::xml::Node& node) {
  static const std::map<std::string_view, ItemKind> kItemKinds = {
      {"block", ItemKind::kBlock},       {"initial", ItemKind::kInitial},
      {"field", ItemKind::kField},       {"record", ItemKind::kRecord},
      {"transfer", ItemKind::kTransfer}, {"subdialog", ItemKind::kSubdialog},
      {"object", ItemKind::kObject}};
  const auto found = kItemKinds.find(node.name);
  if (!node.IsElement() || found == kItemKinds.end()) return {};
  return found->second;
}

/// A <prompt> of an item, or words and markup that stand without one.
struct ItemPrompt {
  std::vector<const vm::xml::Node*> nodes;
  int count = 1;
};

std::vector<ItemPrompt> PromptsIn(const vm::xml::Node& item) {
  std::vector<ItemPrompt> prompts;
  bool goes_on = false;  // what is loose belongs to the one before
  for (const auto& child : item.children) {
    if (child->IsElement("prompt")) {
      prompts.push_back({{child.get()}, std::max(1, std::atoi(child->Get("count").c_str()))});
      goes_on = false;
    } else if (IsLooseSpeech(*child)) {
      if (!goes_on) prompts.push_back({});
      prompts.back().nodes.push_back(child.get());
      goes_on = true;
    } else if (child->IsElement()) {
      goes_on = false;
    }
  }
  std::erase_if(prompts, [](const ItemPrompt& prompt) {
    return std::ranges::all_of(prompt.nodes, [](const vm::xml::Node* node) {
      return !node->IsElement() && vm::xml::IsBlank(node->text);
    });
  });
  return prompts;
}

}  // namespace

template <typename Action>
bool FormInterpreter::Guarded(Action action) {
  try {
    action();
    return true;
  } catch (const EventThrown& event) {
    play_prompts_ = events_.Handle(event, rt_.position.item);
  } catch (const GoToItem& to) {
    rt_.position.dialog->next_item = to.name;
  }
  return false;
}

void FormInterpreter::Run(const Transition& to) {
  Dialog dialog;
  dialog.node = to.dialog;
  rt_.position.dialog = &dialog;
  rt_.position.item = nullptr;
  rt_.scopes.EnterDialog();
  play_prompts_ = true;
  Guarded([&] { InitDialog(to.parameters); });
  if (to.carried) Guarded([&] { process_.Process(*to.carried, nullptr); });
  while (true) {
    FormItem* item = nullptr;
    rt_.scopes.LeaveBlocks();
    rt_.position.element = nullptr;
    rt_.position.item = nullptr;
    const bool selected = Guarded([&] {
      rt_.budget.Step();
      item = Select();
    });
    if (selected && !item) return;
    if (selected) Guarded([&] { Visit(*item); });
  }
}

void FormInterpreter::InitDialog(const NamedValues& parameters) {
  Dialog& dialog = *rt_.position.dialog;
  if (dialog.node->name == "menu") {
    dialog.items.push_back(
        {.node = dialog.node, .kind = ItemKind::kMenu, .name = "", .events = {}});
    return;
  }
  std::size_t taken = 0;
  for (const auto& child : dialog.node->children) {
    if (!child->IsElement()) continue;
    rt_.position.element = child.get();
    // Parameters of a subdialog win over the initial values of the form's variables.
    const auto given =
        std::ranges::find(parameters, child->Get("name"), &NamedValues::value_type::first);
    if (child->name == "var" && given != parameters.end()) {
      rt_.scopes.Store(given->first, given->second);
      ++taken;
    } else if (ExecutableContent::IsInitial(*child)) {
      content_.RunElement(*child);
    } else if (const auto kind = KindOf(*child)) {
      InitItem(*child, *kind);
    }
  }
  rt_.position.element = nullptr;
  if (taken < parameters.size()) {
    rt_.position.ThrowSemantic(*dialog.node,
                               "a <param> has no <var> of its name in the subdialog's form");
  }
}

void FormInterpreter::InitItem(const vm::xml::Node& node, ItemKind kind) {
  FormItem item{.node = &node, .kind = kind, .name = node.Get("name"), .events = {}};
  if (item.name.empty()) item.name = "__item" + std::to_string(++generated_names_);
  const std::string* expression = node.Find("expr");
  rt_.scopes.DeclareItem(
      node, item.name,
      expression ? rt_.scopes.Evaluate(node, *expression) : rt_.engine.Undefined());
  rt_.position.dialog->items.push_back(std::move(item));
}

bool FormInterpreter::IsDone(const FormItem& item) {
  if (item.kind == ItemKind::kMenu) return false;
  return item.over || !rt_.engine.IsUndefined(rt_.scopes.Get(item.name));
}

/// The first item that is not done and whose condition holds, null if there is none. Takes constant
/// time for each item that is done, as long as none is cleared.
FormItem* FormInterpreter::Select() {
  Dialog& dialog = *rt_.position.dialog;
  if (!dialog.next_item.empty()) {
    const std::string wanted = std::exchange(dialog.next_item, "");
    if (FormItem* item = dialog.FindItem(wanted)) return item;
    ThrowEvent("error.badfetch", "the form has no item '" + wanted + "'");
  }
  if (dialog.cleared != rt_.scopes.cleared_items()) dialog.first_open = 0;
  dialog.cleared = rt_.scopes.cleared_items();
  auto& items = dialog.items;
  while (dialog.first_open < items.size() && IsDone(items[dialog.first_open])) ++dialog.first_open;
  for (std::size_t i = dialog.first_open; i < items.size(); ++i) {
    const bool is_menu = items[i].kind == ItemKind::kMenu;
    if (!IsDone(items[i]) && (is_menu || rt_.scopes.Condition(*items[i].node))) return &items[i];
  }
  return nullptr;
}

void FormInterpreter::Visit(FormItem& item) {
  rt_.position.item = &item;
  rt_.position.element = item.node;
  JsonLine line;
  line.Text("item", item.name).Text("element", item.node->name);
  line.Number("line", static_cast<double>(item.node->line));
  rt_.Trace("select", line);
  if (std::exchange(play_prompts_, true)) QueuePrompts(item);
  collect_.Visit(item);
  play_prompts_ = true;  // whatever a subdialog has left there
}

void FormInterpreter::QueuePrompts(FormItem& item) {
  if (item.kind == ItemKind::kBlock) return;
  std::vector<ItemPrompt> prompts = PromptsIn(*item.node);
  std::erase_if(prompts, [&](const ItemPrompt& prompt) {
    return prompt.nodes[0]->IsElement("prompt") && !rt_.scopes.Condition(*prompt.nodes[0]);
  });
  int best = 0;
  for (const ItemPrompt& prompt : prompts) {
    if (prompt.count <= item.prompt_count) best = std::max(best, prompt.count);
  }
  for (const ItemPrompt& prompt : prompts) {
    if (prompt.count != best) continue;
    prompt.nodes[0]->IsElement("prompt") ? prompts_.Queue(*prompt.nodes[0])
                                         : prompts_.QueueLoose(prompt.nodes);
  }
  ++item.prompt_count;
}

}  // namespace vxml
