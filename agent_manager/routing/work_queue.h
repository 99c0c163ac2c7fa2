#pragma once

#include <chrono>
#include <cstddef>
#include <deque>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "agent_manager/routing/envelope.h"

namespace am {

/// Something to do that is no message: an answer to be handed over, a peer to be let go.
struct Work {
  std::function<void()> act;
  PeerKey cause = kHub;  ///< whose error it is if it throws; done after what this peer said before
};

/// What the hub has still to do, in the order in which it came: the one place where messages wait
/// between the peer that said them and whoever takes them. One turn lasts kTurn and the item under
/// way: whoever has caused more than fits into it waits in a lane of its own, in order, and then
/// one item of each lane is taken after the other, so nobody waits for all that another has caused.
/// Its length is bounded by what one read of each peer brings, and by what those who say
/// more for a peer ask of CausedBy before: those in a lane are not read from. Thread: one.
class WorkQueue {
 public:
  using Item = std::variant<Envelope, Work>;
  using Clock = std::function<std::chrono::steady_clock::time_point()>;
  static constexpr std::chrono::milliseconds kTurn{2};
  /// What the hub's own parts have said for one peer, and nobody has taken yet.
  struct Caused {
    std::size_t items = 0, bytes = 0;
  };
  static constexpr std::size_t kMaxCausedBytes = 8u << 20;
  /// `on_lane`: a peer's items have (true) or no longer have (false) a lane of their own.
  explicit WorkQueue(std::function<void(PeerKey cause, bool begins)> on_lane,
                     Clock now = std::chrono::steady_clock::now)
      : on_lane_(std::move(on_lane)), now_(std::move(now)) {}

  void Push(vm::Message message, Origin origin) {
    items_.emplace_back(std::in_place_type<Envelope>, std::move(message), std::move(origin),
                        std::string(), OnAnswer());
  }
  /// Said by one of the hub's own parts on behalf of a peer.
  void PushCaused(Envelope envelope);
  void Post(std::function<void()> act, PeerKey cause = kHub) {
    items_.emplace_back(std::in_place_type<Work>, std::move(act), cause);
  }
  Caused CausedBy(PeerKey cause) const;

  /// Gives the items that are there now to `take`, as many as fit into a turn; what comes meanwhile
  /// stays for the next. False if there were none. Not from within itself.
  bool Drain(const std::function<void(Item& item)>& take);
  /// Turns have no end: on the virtual clock everything is to happen in one order only.
  void set_lockstep(bool lockstep) { lockstep_ = lockstep; }
  bool empty() const { return items_.empty() && lanes_.empty(); }

 private:
  static PeerKey CauseOf(const Item& item);
  void Take(Item& item, const std::function<void(Item& item)>& take);
  void PutIntoLane(PeerKey cause, Item item);
  void TakeFromLane(const std::function<void(Item& item)>& take);

  const std::function<void(PeerKey cause, bool begins)> on_lane_;
  const Clock now_;
  bool lockstep_ = false;
  std::vector<Item> items_, taken_;
  std::map<PeerKey, std::deque<Item>> lanes_;  // by cause; none is empty
  PeerKey last_lane_ = kHub;
  std::map<PeerKey, Caused> caused_;
};

}  // namespace am
