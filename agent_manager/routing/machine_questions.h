#pragma once

#include <map>
#include <string>

#include "agent_manager/routing/limits.h"
#include "agent_manager/routing/work_queue.h"

namespace am {

/// What the hub's own parts have asked of its own machines and not been answered yet. A machine
/// answers with a protocol message, whose tag tells which question it answers.
/// Thread: one. Limits: Limits::pending; beyond it the oldest question is answered with TIMEOUT.
class MachineQuestions {
 public:
  MachineQuestions(WorkQueue& queue, const Limits& limits) : queue_(queue), limits_(limits) {}
  /// Returns the tag of the question. `done` is called from the queue.
  std::string Add(OnAnswer done);
  /// Calls the `done` of the question that this answers. REQUIRES: the machine has said it to the
  /// hub (kHub) and not to a peer, so that the tag is one that Add has made.
  void Resolve(const vm::Message& answer);

 private:
  WorkQueue& queue_;
  const Limits& limits_;
  std::map<unsigned long, OnAnswer> open_;  // by the tag's number, so the oldest first
  unsigned long last_number_ = 0;
};

}  // namespace am
