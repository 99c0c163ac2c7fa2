#pragma once

#include <functional>
#include <optional>

#include "agent_manager/routing/directory.h"

namespace am {

/// The instant of `set SLOT = @T`.
std::optional<vm::Time> StartTimeOf(const vm::Message& message);

/// `set SLOT = @T` for modules that do not know start times: kept here until then, and said as
/// `set SLOT = NOW`. Thread: the scheduler's. All that it is given outlives it.
/// Limits: Limits::pending of them for each module; further ones are said as they are.
class HeldStarts {
 public:
  using Send = std::function<void(Peer& module, const vm::Message& message)>;
  HeldStarts(vm::Scheduler& clock, Directory& directory, const Limits& limits, Send send)
      : clock_(clock), directory_(directory), limits_(limits), send_(std::move(send)) {}

  /// Takes a start time and returns true. Any other `set` of a slot, STOP say, takes the place of a
  /// start that is held for it.
  bool Hold(Peer& module, const vm::Message& message);
  void Forget(Peer& module);
  std::size_t count() const { return count_; }

 private:
  void Start(PeerKey key, const std::string& slot);

  vm::Scheduler& clock_;
  Directory& directory_;
  const Limits& limits_;
  Send send_;
  std::size_t count_ = 0;
};

}  // namespace am
