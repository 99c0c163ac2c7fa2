#pragma once

#include <string>
#include <vector>

#include "task_manager/interpreter/document_set.h"
#include "task_manager/interpreter/prompt_queue.h"

namespace vxml {

/// Turns prompts of a document into ones that can be played, and queues them. On a closed line
/// nothing is evaluated. Errors are thrown as events. Thread: the session's.
class PromptWriter {
 public:
  PromptWriter(Runtime& runtime, DocumentSet& documents, PromptQueue& queue)
      : rt_(runtime), documents_(documents), queue_(queue) {}

  void Queue(const vm::xml::Node& prompt);
  /// Words and markup that stand in executable content without a <prompt>. Blanks alone say
  /// nothing.
  void QueueLoose(const std::vector<const vm::xml::Node*>& nodes);
  /// A <native> outside of prompts: commands in their place among the words.
  void QueueNative(const vm::xml::Node& native);
  /// The platform's own words.
  void QueueWords(const std::string& text, const std::string& language);

 private:
  void Write(Prompt prompt, const std::vector<const vm::xml::Node*>& nodes);

  Runtime& rt_;
  DocumentSet& documents_;
  PromptQueue& queue_;
};

/// Prompt markup that may stand without its <prompt>.
bool IsLooseSpeech(const vm::xml::Node& node);

/// The lines of the module protocol that a <native> holds. Throws error.noauthorization unless the
/// element came from a file of this machine.
std::vector<std::string> NativeLines(Runtime& runtime, const vm::xml::Node& native);

}  // namespace vxml
