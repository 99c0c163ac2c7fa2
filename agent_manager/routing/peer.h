#pragma once

#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "agent_manager/access/file_slots.h"
#include "agent_manager/access/role.h"
#include "agent_manager/routing/dialect.h"
#include "agent_manager/routing/envelope.h"
#include "agent_manager/routing/limits.h"
#include "agent_manager/routing/link.h"
#include "vm_protocol/core/clock_estimate.h"

namespace am {

enum class PeerKind {
  kConsole,  ///< the hub's own terminal or input
  kModule,   ///< from the configuration, or a client that has said `rep Run = LIVE`: probed, its
             ///< clock measured
  kClient,   ///< came by a socket
  kRemote,   ///< a module of another hub, which answers for it: never probed
};

/// A request that waits for its answer.
struct Request {
  PeerKey asker = kHub;
  vm::Message message;
  OnAnswer done{};
  vm::Time asked{0};
  bool members_seen = false;  ///< a group's members have come
};

/// The requests one module has not answered. Only Requests changes it.
struct RequestTable {
  std::map<unsigned long, Request> open;  ///< by the number of our tag, so the oldest first
  std::map<std::string, std::set<unsigned long>> by_slot;  ///< the original's dialect: `inq`
  std::map<PeerKey, std::set<unsigned long>> by_asker;
  vm::TimerId timer = 0;
};

/// A peer's own requests that no module has answered yet. Only Requests changes it.
struct AskedCount {
  std::size_t open = 0;
  bool holds = false;  ///< the peer is not read from until most of them are answered
};

/// Errors of a peer in the second that began at `since`. Only Outbox changes it.
struct ComplaintCount {
  vm::Time since{0};
  int count = 0;
};

/// How a peer reads and is read. Only BackPressure changes it.
struct FlowState {
  RateMeter messages, bytes;
  bool throttled = false;
  int held_by = 0;          ///< reasons why it is not read from
  bool in_lane = false;     ///< it is held since what it has caused waits in a lane of the queue
  std::set<PeerKey> holds;  ///< senders that wait until it has read what they said
  vm::TimerId timer = 0;
  vm::Time full_since{0};
  std::size_t least_backlog = 0;
  bool cut_off = false;
};

/// What the hub knows of a peer's clock.
struct ClockState {
  bool known = false;
  vm::Time offset{0};  ///< the peer's clock minus ours
  vm::Time delay{0};   ///< there and back, of the best exchange
};

/// A message that waits until the hub knows how to say it to its receiver.
struct WaitingMessage {
  vm::Message message;
  Origin origin;
  OnAnswer done{};
};

/// What the hub finds out about a peer's dialect and clock. Only ModuleClocks changes it.
struct ProbeState {
  bool probing = false;      ///< it is being asked whether it knows Clock
  int silent_rounds = 0;     ///< EndProbes has passed over it
  bool measuring = false;    ///< a start time waits for its clock to be known
  bool asked_clock = false;  ///< another hub's clock is measured once a start time needs it
  ClockState clock{};
  vm::ClockEstimate estimate{};
};

/// The messages that wait until the peer is no longer being asked. Only Forwarder changes it.
struct WaitingList {
  std::size_t bytes = 0;
  std::deque<WaitingMessage> messages{};
};

/// Which of a peer's slots take file names. Only FileGuard changes it.
struct FileKnowledge {
  std::optional<FileSlots> slots{};  ///< none: not known yet
  vm::TimerId timer = 0;
};

/// Everything the hub keeps of one peer. Owned by the Directory; it goes only between two items of
/// the queue, so a reference is good for as long as one item is dealt with.
struct Peer {
  PeerKey key = kHub;
  std::string name;
  PeerKind kind = PeerKind::kClient;
  Role role = Role::kGuest;
  Dialect dialect = Dialect::kAuto;
  std::unique_ptr<Link> link;
  bool configured = false;  ///< its name is the configuration's
  std::string folder{};     ///< where it runs, for the files it is told of; empty: as the hub
  bool spoken = false;      ///< anything at all
  std::set<std::string> subscriptions{};
  std::set<std::string> defined{};  ///< its slots and macros at the hub: Router
  Traffic traffic{};
  FlowState flow{};
  RequestTable requests{};
  AskedCount asked{};
  std::size_t delayed_bytes = 0;  ///< of its messages that rules delay: Router
  ProbeState probe{};
  WaitingList waiting{};
  FileKnowledge files{};
  std::map<std::string, vm::TimerId> held_starts{};  ///< `set SLOT = @T` without `@T`: HeldStarts
  vm::Time granted{0};  ///< lockstep, where its clock stands: ClockGrants
  ComplaintCount complaints{};
};

/// The peer that is no longer read from while a hearer of `sender`'s reports has a full backlog:
/// the sender itself. kHub, which means no peer, if the sender is the owner or a module that the
/// hub has started: one slow hearer must not hold these back from all the others.
inline PeerKey WaitsForHearers(const Peer& sender) {
  const bool trusted = sender.role == Role::kOwner || sender.role == Role::kModule;
  return trusted ? kHub : sender.key;
}

/// What there is to know about a peer that is there.
struct PeerStatus {
  std::string name;
  PeerKind kind = PeerKind::kClient;
  Role role = Role::kGuest;
  Traffic traffic;
  std::size_t backlog_bytes = 0;
  std::size_t pending = 0;  ///< requests it has not answered
  std::size_t defined = 0;  ///< slots and macros it has made at the hub
  bool held = false;        ///< it is not read from at the moment
};

}  // namespace am
