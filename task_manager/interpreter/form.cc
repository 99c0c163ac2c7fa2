#include "task_manager/document/schema.h"
#include "task_manager/fetch/uri.h"
#include "task_manager/interpreter/dialog_session.h"
#include "task_manager/interpreter/scope_guard.h"

namespace vxml {

using script::Value;

namespace {

std::optional<ItemKind> KindOf(const vm::xml::Node& node) {
  static const std::map<std::string, ItemKind> kKinds = {
      {"block", ItemKind::kBlock},       {"initial", ItemKind::kInitial},
      {"field", ItemKind::kField},       {"record", ItemKind::kRecord},
      {"transfer", ItemKind::kTransfer}, {"subdialog", ItemKind::kSubdialog},
      {"object", ItemKind::kObject}};
  const auto found = kKinds.find(node.name);
  if (!node.IsElement() || found == kKinds.end()) return {};
  return found->second;
}

}  // namespace

void DialogSession::RunDialog(const vm::xml::Node& node, std::shared_ptr<Match> carried) {
  Dialog dialog;
  dialog.node = &node;
  dialog.scope = engine_.NewScope();
  dialog_ = &dialog;
  scope_item_ = nullptr;
  engine_.Set(context_->names, "dialog", dialog.scope);
  bool play_prompts = true;
  const auto guarded = [&](auto&& action) {
    try {
      action();
      return true;
    } catch (const EventThrown& event) {
      play_prompts = HandleEvent(event, scope_item_);
    } catch (const GoToItem& to) {
      dialog.next_item = to.name;
    }
    return false;
  };
  guarded([&] { InitForm(dialog); });
  if (carried) guarded([&] { TakeMatch(*carried, nullptr); });
  while (true) {
    Item* item = nullptr;
    anonymous_.clear();
    active_node_ = nullptr;
    scope_item_ = nullptr;
    const bool selected = guarded([&] {
      Step();
      item = Select();
    });
    if (!selected) continue;
    if (!item) return;
    guarded([&] {
      scope_item_ = item;
      active_node_ = item->node;
      JsonLine line;
      line.Text("item", item->name).Text("element", item->node->name);
      line.Number("line", static_cast<double>(item->node->line));
      Trace("select", line);
      if (play_prompts) QueuePrompts(*item);
      play_prompts = true;
      Visit(*item);
    });
  }
}

void DialogSession::InitForm(Dialog& dialog) {
  if (dialog.node->name == "menu") {
    Item item;
    item.node = dialog.node;
    item.kind = ItemKind::kMenu;
    dialog.items.push_back(item);
    return;
  }
  // Parameters of a subdialog win over the initial values of the form's variables.
  std::map<std::string, Value> parameters;
  for (auto& [name, value] : context_->parameters) parameters[name] = value;
  context_->parameters.clear();
  const std::size_t given = parameters.size();
  std::size_t taken = 0;
  for (const auto& child : dialog.node->children) {
    if (!child->IsElement()) continue;
    active_node_ = child.get();
    if (child->name == "var" && parameters.contains(child->Get("name"))) {
      Store(child->Get("name"), parameters[child->Get("name")]);
      ++taken;
    } else if (child->name == "var" || child->name == "script" || child->name == "data") {
      RunElement(*child);
    } else if (KindOf(*child)) {
      InitItem(dialog, *child);
    }
  }
  active_node_ = nullptr;
  if (taken < given) {
    ThrowSemantic(*context_->document, *dialog.node,
                  "a <param> has no <var> of its name in the subdialog's form");
  }
}

void DialogSession::InitItem(Dialog& dialog, const vm::xml::Node& node) {
  Item item;
  item.node = &node;
  item.kind = *KindOf(node);
  item.name = node.Get("name");
  if (item.name.empty()) {
    item.name = "__item" + std::to_string(++generated_names_);
  }
  const std::string* expression = node.Find("expr");
  const Value value = expression ? Evaluate(node, *expression) : engine_.Undefined();
  Declare(node, item.name, value);
  dialog.items.push_back(std::move(item));
}

bool DialogSession::IsDone(const Item& item) {
  if (item.kind == ItemKind::kMenu) return false;
  return item.over || !engine_.IsUndefined(Variable(item.name));
}

Item* DialogSession::Select() {
  if (!dialog_->next_item.empty()) {
    const std::string wanted = std::exchange(dialog_->next_item, "");
    for (Item& item : dialog_->items) {
      if (item.name == wanted) return &item;
    }
    ThrowEvent("error.badfetch", "the form has no item '" + wanted + "'");
  }
  Dialog& dialog = *dialog_;
  std::size_t at = dialog.first_open_at == engine_.changes() ? dialog.first_open : 0;
  std::optional<std::size_t> open;
  for (; at < dialog.items.size(); ++at) {
    const Item& item = dialog.items[at];
    if (IsDone(item)) continue;
    if (!open) open = at;
    if (item.kind == ItemKind::kMenu || Condition(*item.node)) break;
  }
  dialog.first_open = open.value_or(at);
  dialog.first_open_at = engine_.changes();
  return at < dialog.items.size() ? &dialog.items[at] : nullptr;
}

/// The prompts of the highest count not above the item's counter (VoiceXML 2.0 section 4.1.6).
void DialogSession::QueuePrompts(Item& item) {
  if (item.kind == ItemKind::kBlock) return;
  struct Candidate {
    std::vector<const vm::xml::Node*> nodes;
    int count;
  };
  std::vector<Candidate> candidates;
  int best = 0;
  const auto consider = [&](std::vector<const vm::xml::Node*> nodes, int count) {
    if (nodes.empty() || count > item.prompt_count) return;
    best = std::max(best, count);
    candidates.push_back({std::move(nodes), count});
  };
  std::vector<const vm::xml::Node*> loose;
  const auto end_loose = [&] {
    bool something = false;
    for (const vm::xml::Node* node : loose)
      something = something || node->IsElement() || !vm::xml::IsBlank(node->text);
    if (something) consider(loose, 1);
    loose.clear();
  };
  const ElementRule* speech = FindElementRule("prompt");
  for (const auto& child : item.node->children) {
    if (child->IsElement("prompt")) {
      end_loose();
      if (!Condition(*child)) continue;
      consider({child.get()}, std::max(1, std::atoi(child->Get("count", "1").c_str())));
    } else if (child->IsText() || (child->IsElement() && Allows(*speech, child->name))) {
      loose.push_back(child.get());
    } else if (child->IsElement()) {
      end_loose();
    }
  }
  end_loose();
  for (const Candidate& candidate : candidates) {
    if (candidate.count != best) continue;
    if (candidate.nodes.size() == 1 && candidate.nodes[0]->IsElement("prompt")) {
      QueuePrompt(*candidate.nodes[0]);
    } else {
      QueueImplicit(candidate.nodes);
    }
  }
  ++item.prompt_count;
}

void DialogSession::Visit(Item& item) {
  switch (item.kind) {
    case ItemKind::kBlock: {
      Store(item.name, engine_.Boolean(true));
      item.over = !item.node->Has("name");  // nobody knows the name it was given
      dialog_->first_open_at = engine_.changes();
      const ScopeGuard guard(*this);
      return RunContent(*item.node);
    }
    case ItemKind::kInitial:
    case ItemKind::kField:
    case ItemKind::kMenu:
      return VisitInput(item);
    case ItemKind::kRecord:
      return VisitRecord(item);
    case ItemKind::kTransfer:
      return VisitTransfer(item);
    case ItemKind::kSubdialog:
      return VisitSubdialog(item);
    case ItemKind::kObject:
      return VisitObject(item);
  }
}

void DialogSession::VisitInput(Item& item) {
  const bool modal = item.kind == ItemKind::kField && item.node->Get("modal", "false") == "true";
  const std::vector<ActiveGrammar> active = ActiveGrammars(item, modal);
  if (active.empty()) {
    ThrowSemantic(*context_->document, *item.node, "input is expected, but no grammar is active");
  }
  if (hung_up_ || disconnected_) throw ExitSession{"hangup"};
  const Listen listen = MakeListen(item, active);
  std::vector<Prompt> queue = std::exchange(queue_, {});
  const Input input = platform_.Collect(queue, listen);
  budget_.Renew();
  TakeMatch(HandleInput(input, active), &item);
}

/// Process phase: what an input in any scope leads to.
void DialogSession::TakeMatch(const Match& match, Item* current) {
  switch (match.owner) {
    case Match::Owner::kUniversal:
      ThrowEvent(match.utterance);
    case Match::Owner::kChoice:
      // A menu with document scope is entered first: what its choice throws is the menu's to
      // handle.
      if (match.node->parent != dialog_->node) return TransitTo(match, match.node->parent);
      return FollowTarget(*match.node, *match.document);
    case Match::Owner::kLink:
      return FollowTarget(*match.node, *match.document);
    case Match::Owner::kForm:
      if (match.node != dialog_->node) TransitTo(match, match.node);
      break;
    case Match::Owner::kItem:
      break;
  }
  std::set<std::string> filled;
  Fill(match, current, filled);
  RunFilled(filled);
}

void DialogSession::TransitTo(const Match& match, const vm::xml::Node* dialog) {
  Transition to;
  to.root = context_->root;
  to.document = match.document == context_->document.get() ? context_->document : context_->root;
  to.same_document = to.document == context_->document;
  to.dialog = dialog;
  to.carried = std::make_shared<Match>(match);
  throw to;
}

/// A link or choice that was chosen: on to its document, or its event.
void DialogSession::FollowTarget(const vm::xml::Node& node, const VxmlDocument& document) {
  std::string event = node.Get("event");
  if (const std::string* expression = node.Find("eventexpr")) event = TextOf(node, *expression);
  if (!event.empty()) {
    EventThrown thrown{event, "", false};
    if (const std::string* message = node.Find("message")) {
      thrown.message = *message;
      thrown.has_message = true;
    } else if (const std::string* expression = node.Find("messageexpr")) {
      thrown.message = TextOf(node, *expression);
      thrown.has_message = true;
    }
    throw thrown;
  }
  std::string next = node.Get("next");
  if (const std::string* expression = node.Find("expr")) next = TextOf(node, *expression);
  // References are relative to the document the link stands in, which may be the root.
  if (&document != context_->document.get()) {
    next = next.starts_with("#") ? document.uri + next : fetch::Resolve(document.base, next);
  }
  throw Locate(node, next, "document");
}

}  // namespace vxml
