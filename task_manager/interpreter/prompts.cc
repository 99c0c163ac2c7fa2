#include "task_manager/interpreter/dialog_session.h"
#include "task_manager/interpreter/prompt_builder.h"

namespace vxml {

void DialogSession::QueuePrompt(const vm::xml::Node& node) {
  if (hung_up_ || disconnected_) return;
  Prompt prompt;
  prompt.language = LanguageAt(node);
  RequireLanguage(prompt.language);
  prompt.bargein = node.Get("bargein", Property("bargein", &node)) != "false";
  prompt.hotword = node.Get("bargeintype", Property("bargeintype", &node)) == "hotword";
  if (const std::string* timeout = node.Find("timeout")) {
    prompt.timeout = ParseTime(*timeout);
    if (!prompt.timeout) {
      ThrowSemantic(*context_->document, node, "timeout '" + *timeout + "' is no time");
    }
  }
  PromptBuilder builder(*this, prompt);
  builder.Add(node);
  builder.Finish();
  Step((prompt.text.size() + prompt.ssml.size()) / kBytesOfAStep);
  queue_.push_back(std::move(prompt));
}

void DialogSession::QueueImplicit(const std::vector<const vm::xml::Node*>& nodes) {
  if (hung_up_ || disconnected_) return;
  Prompt prompt;
  prompt.language = LanguageAt(*nodes.front()->parent);
  RequireLanguage(prompt.language);
  prompt.bargein = Property("bargein") != "false";
  prompt.hotword = Property("bargeintype") == "hotword";
  PromptBuilder builder(*this, prompt);
  for (const vm::xml::Node* node : nodes) builder.Add(*node);
  builder.Finish();
  Step((prompt.text.size() + prompt.ssml.size()) / kBytesOfAStep);
  queue_.push_back(std::move(prompt));
}

/// Plays what is queued, to its end.
void DialogSession::Flush() {
  if (queue_.empty()) return;
  const std::vector<Prompt> queue = std::exchange(queue_, {});
  if (platform_.Play(queue)) return;
  hung_up_ = true;
  ThrowEvent("connection.disconnect.hangup");
}

}  // namespace vxml
