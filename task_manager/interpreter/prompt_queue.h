#pragma once

#include <utility>
#include <vector>

#include "task_manager/interpreter/runtime.h"

namespace vxml {

/// Prompts that wait to be played: until input is waited for, or the session ends (VoiceXML 2.0
/// section 4.1.8). On a closed line nothing is queued. Thread: the session's.
class PromptQueue {
 public:
  explicit PromptQueue(Runtime& runtime) : rt_(runtime) {}

  /// Counts its markup against the budget; its words were counted as they were written.
  void Add(Prompt prompt);
  /// A <native> by itself: its commands wait for their turn, or are carried out at once if the line
  /// is closed.
  void AddCommands(Prompt prompt);
  /// For the platform, which plays them.
  std::vector<Prompt> Take() { return std::exchange(queue_, {}); }
  /// Plays what is queued, to its end. Throws connection.disconnect.hangup.
  void Flush();
  /// At the end of the session: plays what is queued if there is still somebody to hear it.
  void Finish();
  const std::vector<Prompt>& prompts() const { return queue_; }

 private:
  Runtime& rt_;
  std::vector<Prompt> queue_;
};

}  // namespace vxml
