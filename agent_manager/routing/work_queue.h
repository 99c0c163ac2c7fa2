#pragma once

#include <functional>
#include <utility>
#include <variant>
#include <vector>

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
  void Push(vm::Message message, Origin origin) {
    items_.emplace_back(std::in_place_type<Envelope>, std::move(message), std::move(origin),
                        std::string(), OnAnswer());
  }
  void Push(Envelope envelope) {
    items_.emplace_back(std::in_place_type<Envelope>, std::move(envelope));
  }
  void Post(std::function<void()> act, PeerKey blamed = kHub) {
    items_.emplace_back(std::in_place_type<Work>, std::move(act), blamed);
  }
  /// Gives each item that is there now to `take`; what comes meanwhile stays for the next time.
  /// Returns how many there were. Not from within itself.
  template <typename Take>
  std::size_t Drain(const Take& take) {
    taken_.swap(items_);
    for (Item& item : taken_) take(item);
    const std::size_t count = taken_.size();
    taken_.clear();
    // What a flood once needed is given back.
    if (taken_.capacity() > kKeptItems) taken_ = {};
    return count;
  }
  bool empty() const { return items_.empty(); }
  std::size_t size() const { return items_.size(); }

 private:
  static constexpr std::size_t kKeptItems = 16384;
  std::vector<Item> items_, taken_;
};

}  // namespace am
