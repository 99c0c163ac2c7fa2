#pragma once

#include <functional>
#include <string>

#include "agent_manager/mqtt/broker.h"
#include "agent_manager/mqtt/topics.h"

namespace am::mqtt {

/// Claims our agent's name at the broker, so that only one hub goes by it. On each connection it
/// subscribes to $state and $hub, sends itself a marker on $reply and waits for it: by then the
/// retained values have come. If another hub is ONLINE under the name, the connection rests and the
/// claim is repeated later. Of two hubs that find the name free in the same moment, the one with
/// the greater id stays.
/// Ownership: borrows the broker; its destruction publishes OFFLINE if the name is held.
/// Thread: the scheduler's. Errors: none of its own; state() says why the name is not held.
class AgentClaim {
 public:
  static constexpr const char* kOnline = "ONLINE";
  struct Hooks {
    std::function<void()> on_held;                           ///< the name is ours from now on
    std::function<void()> on_contested;                      ///< id() is to be published again
    std::function<void(const std::string& state)> on_state;  ///< each change of state()
  };
  AgentClaim(Broker& broker, const MqttConfig& config, Hooks hooks);
  ~AgentClaim();
  AgentClaim(const AgentClaim&) = delete;

  /// What the broker publishes when it loses us.
  static Packet Will(const MqttConfig& config);
  /// The broker is connected.
  void Begin();
  void Lost(const std::string& reason);
  /// True if the packet was about the claim: $state, $hub, or the marker.
  bool OnPacket(const Topic& topic, const Packet& packet);

  bool held() const { return held_; }
  /// "ONLINE tcp:HOST:PORT as AGENT", "AWAY why".
  const std::string& state() const { return state_; }
  /// Stands at $hub for everybody to read: it tells our process from others, and is no secret.
  const std::string& id() const { return id_; }

 private:
  void Decide();
  void OnHub(const std::string& hub);
  void Yield();
  void SetState(const std::string& state);

  Broker& broker_;
  const MqttConfig& config_;
  const AgentTopics topics_;
  const Hooks hooks_;
  const std::string id_, marker_;
  bool claiming_ = false;  // connected, and finding out whether the name is free
  bool held_ = false;
  std::string seen_state_, seen_hub_;  // what stands at the broker meanwhile
  std::string state_;
};

}  // namespace am::mqtt
