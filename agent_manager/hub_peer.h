#pragma once

#include <deque>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "agent_manager/clock_estimate.h"
#include "agent_manager/hub.h"

/// The hub's own view of a peer, shared by the files that make up the hub. Not for others.
namespace am {

/// The asker of what the hub asks itself.
inline constexpr PeerKey kHub = 0;

/// When a module comes; the quickest one counts.
inline constexpr int kClockExchanges = 5;

/// The hub's own tags: "h" and a number; the number is 0 if it is no tag of ours.
std::string HubTag(unsigned long number);
unsigned long HubTagNumber(std::string_view tag);

/// A request that waits for its answer.
struct Hub::Pending {
  PeerKey asker = kHub;
  vm::Message request;
  OnAnswer done;
  vm::TimerId limit = 0;
  bool members_seen = false;  // a group's members have come
};

struct Hub::Peer {
  PeerKey key = 0;
  std::string name;
  PeerKind kind = PeerKind::kClient;
  Dialect dialect = Dialect::kAuto;
  std::unique_ptr<Link> link;
  bool probing = false;
  bool spoken = false;                                // anything at all
  int silent_rounds = 0;                              // EndProbes passed over it
  std::deque<Pending> waiting;                        // said before it was known how to say it
  std::map<unsigned long, Pending> pending;           // by the number in our tag
  std::map<std::string, std::vector<Pending>> asked;  // original dialect: inq, by slot
  std::map<std::string, vm::TimerId> held;            // original dialect: starts held back, by slot
  bool measuring = false;    // a start time waits for its clock to be known
  bool asked_clock = false;  // another hub's clock is measured once a start time needs it
  ClockState clock;
  ClockEstimate estimate;
  vm::Time granted{0};  // lockstep: where its clock stands
  std::set<std::string> subscriptions;
  Traffic traffic;
  RateMeter messages, bytes;
  bool throttled = false;
  int held_by = 0;          // reasons why it is not read from
  std::set<PeerKey> holds;  // senders that wait until it has read what they said
  vm::TimerId backlog_timer = 0;
  vm::Time full_since{0};
  std::size_t least_backlog = 0;
  bool cut_off = false;
  std::set<std::string> defined;  // its slots and macros at the hub
  vm::Time complaints_since{0};
  int complaints = 0;
};

}  // namespace am
