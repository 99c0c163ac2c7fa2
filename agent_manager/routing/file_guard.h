#pragma once

#include <functional>

#include "agent_manager/access/rights.h"
#include "agent_manager/routing/directory.h"

namespace am {

/// Whether a message on its way to a peer may name the files it names. A module of ours is asked
/// once which of its slots take file names; one that does not tell within kDeclareLimit, and any
/// other peer, is judged by the table of well-known names.
/// Thread: the scheduler's. All that it is given outlives it.
class FileGuard {
 public:
  static constexpr vm::Time kDeclareLimit = std::chrono::seconds(2);
  FileGuard(vm::Scheduler& clock, Directory& directory, const AccessControl& access)
      : clock_(clock), directory_(directory), access_(access) {}

  /// True if a message said with this role has to wait until the peer has told its file slots.
  bool MustAsk(const Peer& peer, Role role) const;
  /// Asks by `ask`, unless it is being asked already; `known` once the answer is there.
  using Ask = std::function<void(Peer& peer, vm::Message question, OnAnswer done)>;
  void AskSlots(Peer& peer, const Ask& ask, std::function<void(Peer& peer)> known);
  /// Errors: kAccess.
  vm::Result<void> Check(const Peer& peer, const vm::Message& message, Role role) const;
  void Forget(Peer& peer);
  /// Modules that are being asked.
  std::size_t count() const { return count_; }

 private:
  vm::Result<void> CheckFiles(const Peer& peer, const vm::Message& message, Role role) const;

  vm::Scheduler& clock_;
  Directory& directory_;
  const AccessControl& access_;
  std::size_t count_ = 0;
};

}  // namespace am
