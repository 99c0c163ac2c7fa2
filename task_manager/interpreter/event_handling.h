#pragma once

#include <optional>
#include <string>
#include <vector>

#include "task_manager/interpreter/executable_content.h"

namespace vxml {

/// Finds and runs the handlers of events (VoiceXML 2.0 section 5.2), the platform's own included.
/// Thread: the session's.
class EventHandling {
 public:
  EventHandling(Runtime& runtime, ExecutableContent& content, PromptWriter& prompts)
      : rt_(runtime), content_(content), prompts_(prompts) {}

  /// Runs the handler an event finds, and those of the events it throws in turn. True if prompts
  /// are to be played next. `item` is where it was thrown, null outside of items.
  bool Handle(EventThrown event, FormItem* item);

 private:
  struct Handler {
    const vm::xml::Node* node = nullptr;
    int count = 1;
    int counter = 1;
    std::string default_action;  ///< of the platform's own handlers
  };
  Handler Find(const EventThrown& event, FormItem* item);
  void AddHandlersIn(const vm::xml::Node& scope, const EventThrown& event,
                     const EventCounters& counters, std::vector<Handler>& handlers);
  bool Run(const Handler& handler, const EventThrown& event);
  bool RunDefault(const std::string& action, const EventThrown& event);
  EventCounters& CountersOf(FormItem* item);

  Runtime& rt_;
  ExecutableContent& content_;
  PromptWriter& prompts_;
  EventCounters of_document_;  ///< while no dialog runs
};

}  // namespace vxml
