#pragma once

#include <functional>
#include <memory>
#include <string>

#include "agent_manager/access/role.h"
#include "vm_protocol/core/message.h"
#include "vm_protocol/core/result.h"
#include "vm_protocol/core/scheduler.h"
#include "vm_protocol/core/slot_machine.h"

namespace am {

/// Identifies a peer for its lifetime; never used again. 0 is the hub itself.
using PeerKey = vm::PeerId;
inline constexpr PeerKey kHub = 0;

/// The answer to a request of one of the hub's own parts. Called by the loop, never within a call.
using OnAnswer = std::function<void(const vm::Result<std::string>& answer)>;
inline void IgnoreAnswer(const vm::Result<std::string>&) {}

/// On whose behalf something is said. What a macro says carries the origin of whoever started it.
struct Origin {
  PeerKey peer = kHub;
  Role role = Role::kGuest;
  /// How many macros have started each other since a peer spoke, without time passing between.
  unsigned depth = 0;
  /// Lines that the outermost `do` may still say; null outside of one.
  std::shared_ptr<std::size_t> lines_left{};

  /// The hub itself, which may do everything.
  static Origin OfHub() { return {.peer = kHub, .role = Role::kOwner}; }
};

/// Beyond this depth a message is answered with LIMIT: macros that start themselves end there.
inline constexpr unsigned kMaxOriginDepth = 64;

/// One message in the hub's queue. It was parsed when it came in and is written when it goes out.
struct Envelope {
  vm::Message message;
  Origin origin;
  std::string machine{};  ///< the hub's own part that says it; empty: the peer of the origin
  OnAnswer done{};        ///< for requests of the hub's own parts
};

}  // namespace am
