#include "task_manager/interpreter/process_phase.h"

#include <algorithm>
#include <vector>

#include "task_manager/document/schema.h"

namespace vxml {

using script::Value;

void ProcessPhase::Process(const Match& match, FormItem* current) {
  const vm::xml::Node* dialog = rt_.position.dialog->node;
  switch (match.owner) {
    case Match::Owner::kUniversal:
      ThrowEvent(rt_.engine.ToString(match.value));
    case Match::Owner::kChoice:
      // A menu with document scope is entered first: what its choice throws is the menu's to
      // handle.
      if (match.node->parent != dialog) TransitTo(match, match.node->parent);
      FollowTarget(*match.node, *match.document);
    case Match::Owner::kLink:
      FollowTarget(*match.node, *match.document);
    case Match::Owner::kForm:
      if (match.node != dialog) TransitTo(match, match.node);
      return RunFilled(FillForm(match));
    case Match::Owner::kItem:
      return RunFilled(current ? FillItem(match, *current) : FillForm(match));
  }
}

void ProcessPhase::TransitTo(const Match& match, const vm::xml::Node* dialog) {
  Transition to;
  to.root = rt_.position.root;
  to.document =
      match.document == rt_.position.document.get() ? rt_.position.document : rt_.position.root;
  to.same_document = to.document == rt_.position.document;
  to.dialog = dialog;
  to.carried = std::make_shared<Match>(match);
  throw to;
}

void ProcessPhase::FollowTarget(const vm::xml::Node& node, const VxmlDocument& document) {
  const EventThrown event = rt_.scopes.Event(node);
  if (!event.name.empty()) throw event;
  std::string next = rt_.scopes.Text(node, "next", "expr");
  // References are relative to the document the link stands in, which may be the root.
  if (&document != rt_.position.document.get()) {
    next = next.starts_with("#") ? document.uri + next : fetch::Resolve(document.base, next);
  }
  throw documents_.Locate(node, next);
}

void ProcessPhase::FillPlain(const FormItem& item, const Value& value) {
  rt_.scopes.Store(item.name, value);
  Report(item);
  RunFilled({item.name});
}

Value ProcessPhase::Slot(Value value, const std::string& path) {
  rt_.budget.Step(0);
  for (std::size_t at = 0; rt_.engine.IsObject(value);) {
    const std::size_t end = std::min(path.find('.', at), path.size());
    value = rt_.engine.Get(value, path.substr(at, end - at));
    if (end == path.size()) return value;
    at = end + 1;
  }
  return {};
}

ProcessPhase::Names ProcessPhase::FillItem(const Match& match, const FormItem& item) {
  Value value = match.value;
  if (rt_.engine.IsObject(value) && !rt_.engine.IsArray(value)) {
    const Value part = Slot(value, item.node->Get("slot", item.name));
    if (part.valid() && !rt_.engine.IsUndefined(part)) value = part;
  }
  Store(item, value, match);
  return {item.name};
}

ProcessPhase::Names ProcessPhase::FillForm(const Match& match) {
  Names filled;
  for (const FormItem& item : rt_.position.dialog->items) {
    if (item.kind != ItemKind::kField) continue;
    const Value value = Slot(match.value, item.node->Get("slot", item.name));
    if (!value.valid() || rt_.engine.IsUndefined(value)) continue;
    Store(item, value, match);
    filled.insert(item.name);
  }
  if (filled.empty()) return filled;
  for (const FormItem& item : rt_.position.dialog->items) {
    if (item.kind == ItemKind::kInitial) rt_.scopes.Store(item.name, rt_.engine.Boolean(true));
  }
  return filled;
}

/// The item's variable and its shadow variable.
void ProcessPhase::Store(const FormItem& item, const Value& value, const Match& match) {
  script::Engine& engine = rt_.engine;
  rt_.scopes.Store(item.name, value);
  const Value shadow = engine.Object();
  recognition_.Describe(shadow, match);
  const Value last = rt_.scopes.last_result();
  for (const char* mark :
       {"markname", "marktime", "recording", "recordingsize", "recordingduration"}) {
    if (engine.Has(last, mark)) engine.Set(shadow, mark, engine.Get(last, mark));
  }
  rt_.scopes.Store(item.name + "$", shadow);
  Report(item);
}

void ProcessPhase::Report(const FormItem& item) {
  JsonLine line;
  line.Text("item", item.name).Raw("value", rt_.engine.ToJson(rt_.scopes.Get(item.name)));
  rt_.platform.Report("filled", line);
}

void ProcessPhase::RunFilled(const Names& filled) {
  if (filled.empty()) return;
  auto& items = rt_.position.dialog->items;
  for (const auto& child : rt_.position.dialog->node->children) {
    if (child->IsElement("filled")) {
      if (!FormFilledApplies(*child, filled)) continue;
      rt_.position.item = nullptr;
      content_.RunBlock(*child);
      continue;
    }
    const auto item = std::ranges::find(items, child.get(), &FormItem::node);
    if (item == items.end() || !filled.contains(item->name)) continue;
    for (const auto& inner : child->children) {
      if (!inner->IsElement("filled")) continue;
      rt_.position.item = &*item;
      content_.RunBlock(*inner);
    }
  }
}

bool ProcessPhase::FormFilledApplies(const vm::xml::Node& node, const Names& filled) {
  std::vector<std::string> names;
  const std::string namelist = node.Get("namelist");
  for (const std::string_view word : SplitWords(namelist)) names.emplace_back(word);
  if (names.empty()) {
    for (const FormItem& item : rt_.position.dialog->items) {
      if (item.IsInput()) names.push_back(item.name);
    }
  }
  const bool any_new =
      std::ranges::any_of(names, [&](const std::string& name) { return filled.contains(name); });
  const bool all = std::ranges::none_of(
      names, [&](const std::string& name) { return rt_.engine.IsUndefined(rt_.scopes.Get(name)); });
  return any_new && (all || node.Get("mode", "all") == "any");
}

}  // namespace vxml
