// From what was recognised to the variables of a form, and on to its <filled>.
#include <algorithm>

#include "task_manager/document/schema.h"
#include "task_manager/interpreter/dialog_session.h"
#include "task_manager/interpreter/scope_guard.h"

namespace vxml {

using script::Value;

namespace {

/// "a.b" looked up part by part.
Value Dig(script::Engine& engine, Value value, const std::string& path) {
  for (std::size_t at = 0; at <= path.size() && engine.IsObject(value);) {
    const std::size_t end = std::min(path.find('.', at), path.size());
    value = engine.Get(value, path.substr(at, end - at));
    at = end + 1;
    if (at > path.size()) return value;
  }
  return {};
}

}  // namespace

/// Results to variables (VoiceXML 2.0 section 3.1.6).
void DialogSession::Fill(const Match& match, Item* current, std::set<std::string>& filled) {
  if (match.owner == Match::Owner::kItem && current) {
    const std::string slot = current->node->Get("slot", current->name);
    Value value = match.value;
    if (engine_.IsObject(value) && !engine_.IsArray(value)) {
      const Value part = Dig(engine_, value, slot);
      if (part.valid() && !engine_.IsUndefined(part)) value = part;
    }
    Store(current->name, value);
    SetShadow(current->name, match);
    filled.insert(current->name);
    return;
  }
  for (Item& item : dialog_->items) {
    if (item.kind != ItemKind::kField) continue;
    const Value value = Dig(engine_, match.value, item.node->Get("slot", item.name));
    if (!value.valid() || engine_.IsUndefined(value)) continue;
    Store(item.name, value);
    SetShadow(item.name, match);
    filled.insert(item.name);
  }
  if (filled.empty()) return;
  for (Item& item : dialog_->items) {
    if (item.kind == ItemKind::kInitial) Store(item.name, engine_.Boolean(true));
  }
}

void DialogSession::SetShadow(const std::string& name, const Match& match) {
  const Value shadow = engine_.Object();
  engine_.Set(shadow, "utterance", engine_.String(match.utterance));
  engine_.Set(shadow, "confidence", engine_.Number(match.confidence));
  engine_.Set(shadow, "inputmode", engine_.String(match.dtmf ? "dtmf" : "voice"));
  engine_.Set(shadow, "interpretation", match.value);
  const Value last = engine_.Get(context_->application, "lastresult$");
  for (const char* mark :
       {"markname", "marktime", "recording", "recordingsize", "recordingduration"}) {
    if (engine_.Has(last, mark)) engine_.Set(shadow, mark, engine_.Get(last, mark));
  }
  Store(name + "$", shadow);
  JsonLine line;
  line.Text("item", name).Raw("value", engine_.ToJson(Variable(name)));
  platform_.Report("filled", line);
}

void DialogSession::RunFilled(const std::set<std::string>& filled) {
  if (filled.empty()) return;
  for (const auto& child : dialog_->node->children) {
    if (!child->IsElement()) continue;
    if (child->name == "filled") {
      if (!FormFilledApplies(*child, filled)) continue;
      scope_item_ = nullptr;
      active_node_ = child.get();
      const ScopeGuard guard(*this);
      RunContent(*child);
      continue;
    }
    Item* item = nullptr;
    for (Item& candidate : dialog_->items) {
      if (candidate.node == child.get()) item = &candidate;
    }
    if (!item || !filled.contains(item->name)) continue;
    for (const auto& inner : child->children) {
      if (!inner->IsElement("filled")) continue;
      scope_item_ = item;
      active_node_ = inner.get();
      const ScopeGuard guard(*this);
      RunContent(*inner);
    }
  }
}

bool DialogSession::FormFilledApplies(const vm::xml::Node& node,
                                      const std::set<std::string>& filled) {
  std::vector<std::string> names;
  const std::string namelist = node.Get("namelist");
  for (const std::string_view word : SplitWords(namelist)) names.emplace_back(word);
  if (names.empty()) {
    for (const Item& item : dialog_->items) {
      if (item.IsInput()) names.push_back(item.name);
    }
  }
  bool any_new = false;
  bool all = true;
  for (const std::string& name : names) {
    any_new = any_new || filled.contains(name);
    all = all && !engine_.IsUndefined(Variable(name));
  }
  return any_new && (all || node.Get("mode", "all") == "any");
}

}  // namespace vxml
