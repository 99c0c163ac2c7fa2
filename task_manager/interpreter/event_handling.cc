#include "task_manager/interpreter/event_handling.h"

#include <algorithm>
#include <string_view>

#include "task_manager/document/schema.h"

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

EventCounters& EventHandling::CountersOf(FormItem* item) {
  return item ? item->events : rt_.position.dialog ? rt_.position.dialog->events : of_document_;
}

void EventHandling::AddHandlersIn(const vm::xml::Node& scope, const EventThrown& event,
                                  const EventCounters& counters, std::vector<Handler>& handlers) {
  for (const auto& child : scope.children) {
    if (!IsHandler(*child)) continue;
    int counter = -1;
    for (const std::string& prefix : EventsOf(*child)) {
      if (!IsPrefix(prefix, event.name)) continue;
      const auto found = counters.find(prefix);
      counter = std::max(counter, found == counters.end() ? 0 : found->second);
    }
    const int count = std::max(1, std::atoi(child->Get("count", "1").c_str()));
    if (count > counter || !rt_.scopes.Condition(*child)) continue;
    handlers.push_back({child.get(), count, counter, ""});
  }
}

/// VoiceXML 2.0 section 5.2.4: over all scopes from the inside out, the highest count that is
/// reached, and of those the first.
EventHandling::Handler EventHandling::Find(const EventThrown& event, FormItem* item) {
  const Position& at = rt_.position;
  const EventCounters& counters = CountersOf(item);
  std::vector<Handler> handlers;
  if (item && item->node != (at.dialog ? at.dialog->node : nullptr)) {
    AddHandlersIn(*item->node, event, counters, handlers);
  }
  if (at.dialog) AddHandlersIn(*at.dialog->node, event, counters, handlers);
  AddHandlersIn(*at.document->root, event, counters, handlers);
  if (at.root != at.document) AddHandlersIn(*at.root->root, event, counters, handlers);
  const auto own = std::ranges::find_if(kDefaults, [&](const DefaultHandler& handler) {
    return IsPrefix(std::string(handler.event), event.name);
  });
  handlers.push_back({nullptr, 1, 1, std::string(own->action)});  // the last has all events
  return *std::ranges::max_element(handlers, {}, &Handler::count);
}

bool EventHandling::Handle(EventThrown event, FormItem* item) {
  for (int turn = 0; turn <= kMaxHandlerDepth; ++turn) {
    rt_.scopes.LeaveBlocks();
    rt_.position.element = item ? item->node : nullptr;
    rt_.budget.StepForBytes(event.message.size());
    EventCounters& counters = CountersOf(item);
    ++counters[""];
    for (std::size_t at = 0; at < event.name.size();) {
      at = std::min(event.name.find('.', at + 1), event.name.size());
      ++counters[event.name.substr(0, at)];
    }
    JsonLine line;
    line.Text("name", event.name);
    if (event.has_message) line.Text("message", event.message);
    line.Text("item", item ? item->name : "");
    rt_.platform.Report("event", line);
    try {
      return Run(Find(event, item), event);
    } catch (const EventThrown& next) {
      event = next;
    }
  }
  throw ExitSession{"error.noresource"};
}

bool EventHandling::Run(const Handler& handler, const EventThrown& event) {
  JsonLine line;
  line.Text("event", event.name);
  if (handler.node) {
    line.Text("element", handler.node->name)
        .Number("line", static_cast<double>(handler.node->line));
  } else {
    line.Text("element", "default");
  }
  line.Number("count", handler.count).Number("counter", handler.counter);
  rt_.Trace("handler", line);
  if (!handler.node) return RunDefault(handler.default_action, event);
  Scopes::Block block(rt_.scopes);
  block.Set("_event", rt_.engine.String(event.name));
  block.Set("_message",
            event.has_message ? rt_.engine.String(event.message) : rt_.engine.Undefined());
  return content_.RunHandler(*handler.node);
}

bool EventHandling::RunDefault(const std::string& action, const EventThrown& event) {
  bool reprompt = false;
  for (const std::string_view word : SplitWords(action)) {
    if (word == "exit") {
      const bool hangup = event.name.starts_with("connection.disconnect");
      throw ExitSession{hangup ? "hangup" : event.name};
    }
    if (word == "reprompt") {
      reprompt = true;
      continue;
    }
    const std::string language = rt_.position.LanguageAt(rt_.position.Here());
    prompts_.QueueWords(DefaultMessage(std::string(word), language), language);
  }
  return reprompt;
}

}  // namespace vxml
