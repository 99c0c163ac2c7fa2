#pragma once

#include <deque>
#include <functional>
#include <optional>
#include <utility>
#include <variant>

#include "agent_manager/routing/envelope.h"

namespace am {

/// Something to do that is no message: an answer to be handed over, a peer to be let go.
struct Work {
  std::function<void()> act;
  PeerKey blamed = kHub;  ///< whose error it is if it throws
};

/// What the hub has still to do, in the order in which it came: the one place where messages wait
/// between the peer that said them and whoever takes them. Its length is bounded by what one read
/// of each peer brings, and by Limits: readers are held while it is worked off. Thread: one.
class WorkQueue {
 public:
  using Item = std::variant<Envelope, Work>;
  void Push(Envelope envelope) { items_.emplace_back(std::move(envelope)); }
  void Post(std::function<void()> act, PeerKey blamed = kHub) {
    items_.emplace_back(Work{std::move(act), blamed});
  }
  Item Pop() {
    Item item = std::move(items_.front());
    items_.pop_front();
    return item;
  }
  std::size_t size() const { return items_.size(); }
  bool empty() const { return items_.empty(); }

 private:
  std::deque<Item> items_;
};

}  // namespace am
