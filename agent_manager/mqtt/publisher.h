#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>

#include "agent_manager/mqtt/agent_claim.h"
#include "agent_manager/mqtt/broker.h"
#include "agent_manager/routing/peer.h"

namespace am::mqtt {

using OnNotice = std::function<void(const std::string& text)>;

// clang-format off
/// Publishes while the name is held, and bounds what the broker has not yet acknowledged:
///
///     values     retained; beyond kMaxInFlightBytes the latest of each topic waits; all of them
///                are published again on each connection
///     events     beyond kMaxInFlightBytes dropped and counted
///     answers    beyond kMaxInFlightBytesOfAnswers dropped and counted
///     commands   not bounded here: their sender's peer bounds them by its backlog
///
/// Ownership: borrows the broker and the claim. Thread: the scheduler's.
/// Errors: a value beyond the limits, or a packet the broker refuses, is one notice.
// clang-format on
class Publisher {
 public:
  static constexpr std::size_t kMaxValues = 16384;  ///< remembered for the broker
  static constexpr std::size_t kMaxValueBytes = 32u << 20;
  static constexpr std::size_t kShareOfGuests = 4;  ///< a quarter of either
  enum class Whose { kOurs, kGuests };
  static constexpr std::size_t kMaxInFlightBytes = 1u << 20;
  static constexpr std::size_t kMaxInFlightBytesOfAnswers = 4u << 20;

  Publisher(Broker& broker, const AgentClaim& claim, OnNotice on_notice);
  Publisher(const Publisher&) = delete;

  void SetValue(const std::string& topic, const std::string& value, Whose whose = Whose::kOurs);
  /// The broker keeps no more values of topics that begin so, but for one.
  void ForgetValues(const std::string& prefix, const std::string& kept);
  void PublishEvent(const Packet& packet);
  void PublishAnswer(const Packet& packet);
  /// `receiver`: comes back with the receipt. False: the broker is away.
  bool PublishCommand(const Packet& packet, PeerKey receiver);

  /// The name is held.
  void PublishAllValues();
  /// The connection is lost, and with it what was in flight.
  void Lost();
  struct InFlight {
    std::size_t bytes = 0;
    std::string topic{};
    PeerKey receiver = 0;  ///< of a command
  };
  /// What the receipt is about; nothing if we do not wait for it.
  std::optional<InFlight> OnReceipt(const Broker::Events::Receipt& receipt);
  static std::size_t BytesOf(const Packet& packet) {
    return packet.topic.size() + packet.payload.size();
  }
  std::uint64_t dropped() const { return dropped_; }

 private:
  bool Publish(const Packet& packet, PeerKey receiver = 0);
  void PublishBelow(std::size_t limit, const Packet& packet);
  void PublishChanged();
  struct Value {
    std::string text;
    Whose whose = Whose::kOurs;
  };
  struct Room {
    std::size_t values = 0, bytes = 0;
  };
  void Count(const std::string& topic, const Value& value, int sign);

  Broker& broker_;
  const AgentClaim& claim_;
  const OnNotice on_notice_;
  std::map<std::string, Value> values_;  // by topic
  Room all_, guests_;                    // what the values take
  std::set<std::string> changed_;  // topics of which the broker does not know yet what we know
  // By the number of the receipt. Numbers are 16 bits wide, so one can be on its way twice.
  std::multimap<int, InFlight> in_flight_;
  std::size_t in_flight_bytes_ = 0;
  std::uint64_t dropped_ = 0;
};

}  // namespace am::mqtt
