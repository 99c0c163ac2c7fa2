#include "task_manager/document/schema.h"
#include "task_manager/interpreter/dialog_session.h"
#include "task_manager/interpreter/properties.h"
#include "task_manager/interpreter/scope_guard.h"

namespace vxml {
namespace {

constexpr int kMaxHandlerDepth = 100;  ///< events thrown by handlers of events thrown by ...

std::string WithoutDot(std::string name) {
  while (name.ends_with(".")) name.pop_back();
  return name;
}

/// True if `prefix` is the event or its beginning up to a dot; "" is the beginning of all.
bool IsPrefix(const std::string& prefix, const std::string& event) {
  if (prefix.empty() || prefix == event) return true;
  return event.starts_with(prefix) && event.size() > prefix.size() && event[prefix.size()] == '.';
}

/// The events a handler element names; the short forms have their own.
std::vector<std::string> EventsOf(const vm::xml::Node& node) {
  if (node.name != "catch") return {node.name};
  std::vector<std::string> events;
  const std::string list = node.Get("event");
  for (const std::string_view word : SplitWords(list)) {
    events.push_back(word == "*" ? "" : WithoutDot(std::string(word)));
  }
  if (events.empty()) events.emplace_back();
  return events;
}

bool IsHandler(const vm::xml::Node& node) {
  return node.IsElement("catch") || node.IsElement("help") || node.IsElement("noinput") ||
         node.IsElement("nomatch") || node.IsElement("error");
}

struct DefaultHandler {
  std::string_view event;
  std::string_view action;  ///< message key, and what follows: reprompt, exit, nothing
};

// VoiceXML 2.0 section 5.2.5; first match counts.
constexpr DefaultHandler kDefaults[] = {
    {"cancel", ""},
    {"error", "error exit"},
    {"exit", "exit"},
    {"help", "help reprompt"},
    {"noinput", "reprompt"},
    {"nomatch", "nomatch reprompt"},
    {"maxspeechtimeout", "maxspeechtimeout reprompt"},
    {"connection.disconnect", "exit"},
    {"", "other exit"},
};

}  // namespace

void DialogSession::CountEvent(const std::string& name, Item* item) {
  auto& counters = item ? item->events : dialog_ ? dialog_->events : document_events_;
  ++counters[""];
  for (std::size_t at = 0; at < name.size();) {
    at = std::min(name.find('.', at + 1), name.size());
    ++counters[name.substr(0, at)];
  }
}

int DialogSession::CounterOf(const std::string& prefix, Item* item) const {
  const auto& counters = item ? item->events : dialog_ ? dialog_->events : document_events_;
  const auto found = counters.find(prefix);
  return found == counters.end() ? 0 : found->second;
}

void DialogSession::CollectHandlers(const vm::xml::Node& scope, const EventThrown& event,
                                    Item* item, std::vector<Handler>& into) {
  for (const auto& child : scope.children) {
    if (!IsHandler(*child)) continue;
    int counter = -1;
    for (const std::string& prefix : EventsOf(*child)) {
      if (IsPrefix(prefix, event.name)) counter = std::max(counter, CounterOf(prefix, item));
    }
    if (counter < 0) continue;
    const int count = std::max(1, std::atoi(child->Get("count", "1").c_str()));
    if (count > counter || !Condition(*child)) continue;
    into.push_back({child.get(), count, counter, ""});
  }
}

/// VoiceXML 2.0 section 5.2.4: over all scopes from the inside out, the highest count that is
/// reached, and of those the first.
std::optional<DialogSession::Handler> DialogSession::FindHandler(const EventThrown& event,
                                                                 Item* item) {
  std::vector<Handler> handlers;
  if (item && item->node != (dialog_ ? dialog_->node : nullptr)) {
    CollectHandlers(*item->node, event, item, handlers);
  }
  if (dialog_) CollectHandlers(*dialog_->node, event, item, handlers);
  CollectHandlers(*context_->document->root, event, item, handlers);
  if (context_->root != context_->document) {
    CollectHandlers(*context_->root->root, event, item, handlers);
  }
  for (const DefaultHandler& own : kDefaults) {
    if (!IsPrefix(std::string(own.event), event.name)) continue;
    handlers.push_back({nullptr, 1, 1, std::string(own.action)});
    break;
  }
  std::optional<Handler> best;
  for (const Handler& handler : handlers) {
    if (!best || handler.count > best->count) best = handler;
  }
  return best;
}

/// Runs the handler an event finds, and those of the events it throws in turn. True if prompts
/// are to be played next.
bool DialogSession::HandleEvent(EventThrown event, Item* item) {
  struct Depth {
    int& depth;
    explicit Depth(int& d) : depth(++d) {}
    ~Depth() { --depth; }
  };
  for (int turn = 0;; ++turn) {
    const Depth depth(handler_depth_);
    if (turn > kMaxHandlerDepth) throw ExitSession{"error.noresource"};
    anonymous_.clear();
    active_node_ = item ? item->node : nullptr;
    CountEvent(event.name, item);
    JsonLine line;
    line.Text("name", event.name);
    if (event.has_message) line.Text("message", event.message);
    line.Text("item", item ? item->name : "");
    platform_.Report("event", line);
    try {
      const std::optional<Handler> handler = FindHandler(event, item);
      if (!handler) return true;
      return RunHandler(*handler, event);
    } catch (const EventThrown& next) {
      event = next;
    }
  }
}

bool DialogSession::RunHandler(const Handler& handler, const EventThrown& event) {
  JsonLine line;
  line.Text("event", event.name);
  if (handler.node) {
    line.Text("element", handler.node->name)
        .Number("line", static_cast<double>(handler.node->line));
  } else {
    line.Text("element", "default");
  }
  line.Number("count", handler.count).Number("counter", handler.counter);
  Trace("handler", line);
  reprompt_ = false;
  const bool outer = std::exchange(in_handler_, true);
  struct Restore {
    bool& flag;
    bool value;
    ~Restore() { flag = value; }
  } restore{in_handler_, outer};
  if (!handler.node) {
    RunDefault(handler.default_action, event);
    return std::exchange(reprompt_, false);
  }
  ScopeGuard guard(*this);
  engine_.Set(guard.scope(), "_event", engine_.String(event.name));
  engine_.Set(guard.scope(), "_message",
              event.has_message ? engine_.String(event.message) : engine_.Undefined());
  active_node_ = handler.node;
  try {
    RunContent(*handler.node);
  } catch (const GoToItem& to) {
    dialog_->next_item = to.name;
  }
  return std::exchange(reprompt_, false);
}

void DialogSession::RunDefault(const std::string& action, const EventThrown& event) {
  for (const std::string_view word : SplitWords(action)) {
    if (word == "exit") {
      const bool hangup = event.name.starts_with("connection.disconnect");
      throw ExitSession{event.name == "exit" ? "exit" : hangup ? "hangup" : event.name};
    }
    if (word == "reprompt") {
      reprompt_ = true;
      continue;
    }
    if (hung_up_ || disconnected_) continue;
    Prompt prompt;
    prompt.language = LanguageAt(Here());
    prompt.text = DefaultMessage(std::string(word), prompt.language);
    prompt.segments.push_back(
        {Segment::Kind::kText, prompt.text, Millis(0), prompt.language, false, ""});
    prompt.ssml = "<speak version=\"1.0\">" + vm::xml::Escape(prompt.text) + "</speak>";
    queue_.push_back(std::move(prompt));
  }
}

}  // namespace vxml
