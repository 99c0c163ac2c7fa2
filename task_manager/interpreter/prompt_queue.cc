#include "task_manager/interpreter/prompt_queue.h"

namespace vxml {

void PromptQueue::Add(Prompt prompt) {
  if (!rt_.connection.is_open()) return;
  rt_.budget.StepForBytes(prompt.ssml.size());
  queue_.push_back(std::move(prompt));
}

void PromptQueue::AddCommands(Prompt prompt) {
  if (rt_.connection.is_open()) return queue_.push_back(std::move(prompt));
  for (const Segment& segment : prompt.segments) rt_.platform.Native(segment.text);
}

void PromptQueue::Flush() {
  if (queue_.empty()) return;
  if (!rt_.platform.Play(Take())) rt_.connection.HangUp();
}

void PromptQueue::Finish() {
  try {
    if (rt_.connection.is_open()) Flush();
  } catch (const EventThrown&) {
    queue_.clear();
  }
}

}  // namespace vxml
