#pragma once

#include <vector>

#include "task_manager/interpreter/collect_phase.h"
#include "task_manager/interpreter/event_handling.h"

namespace vxml {

/// The form interpretation algorithm (VoiceXML 2.0 appendix C): selects items one after the other,
/// queues their prompts, has them visited and their events handled. Thread: the session's.
class FormInterpreter {
 public:
  FormInterpreter(Runtime& runtime, PromptWriter& prompts, ExecutableContent& content,
                  EventHandling& events, CollectPhase& collect, ProcessPhase& process)
      : rt_(runtime),
        prompts_(prompts),
        content_(content),
        events_(events),
        collect_(collect),
        process_(process) {}

  /// Runs the dialog until no item is left to be visited. What leads away from it is thrown.
  void Run(const Transition& to);

 private:
  /// Carries out the action and handles its event. False: there was one, or a <goto nextitem>.
  template <typename Action>
  bool Guarded(Action action);
  void InitDialog(const NamedValues& parameters);
  void InitItem(const vm::xml::Node& node, ItemKind kind);
  FormItem* Select();
  void Visit(FormItem& item);
  bool IsDone(const FormItem& item);
  /// The prompts of the highest count not above the item's counter (VoiceXML 2.0 section 4.1.6).
  void QueuePrompts(FormItem& item);

  Runtime& rt_;
  PromptWriter& prompts_;
  ExecutableContent& content_;
  EventHandling& events_;
  CollectPhase& collect_;
  ProcessPhase& process_;
  bool play_prompts_ = true;  ///< of the item visited next
  unsigned generated_names_ = 0;
};

}  // namespace vxml
