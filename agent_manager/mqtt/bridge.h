#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "agent_manager/mqtt/agent_claim.h"
#include "agent_manager/mqtt/local_gateway.h"
#include "agent_manager/mqtt/publisher.h"
#include "agent_manager/mqtt/remote_modules.h"

namespace am::mqtt {

/// Joins the hub to an MQTT broker. It owns the connection and the four that use it, and hands each
/// event of the broker to the one it concerns:
///
///     AgentClaim      is our name at the broker ours, and are we online
///     Publisher       what we publish, and what the broker has not acknowledged
///     LocalGateway    our modules, shown to others and spoken to by them: the peer @MQTT
///     RemoteModules   modules of other agents, spoken to from here: the peers @AGENT/MODULE
///
/// docs/scaling.md explains the topics (topics.h).
/// Ownership: its peers leave the hub with it. Thread: the scheduler's.
/// Limits: those of the four; kNoticesPerSecond.
/// Errors: what the broker brings and cannot be used is one notice and, where a response topic says
///         where, one answer.
class Bridge {
 public:
  static constexpr const char* kName = LocalGateway::kName;
  static constexpr int kNoticesPerSecond = 10;

  using Connect = std::function<std::unique_ptr<Broker>(const Packet& will, Broker::Events events)>;
  struct Hooks {
    OnNotice on_notice;
    std::function<void(const std::string& state)> on_state;  ///< each change of State()
  };
  /// Throws std::runtime_error with a sentence.
  Bridge(vm::Scheduler& clock, Hub& hub, MqttConfig config, Hooks hooks, const Connect& connect);
  Bridge(const Bridge&) = delete;

  /// Attaches @AGENT/MODULE if it can be. False: the name is none of another agent.
  vm::Result<bool> Open(const std::string& name, Role asker) { return remotes_.Open(name, asker); }
  /// Somebody wants to hear this module of another agent, now and whenever it is there.
  void Want(const std::string& name, Role role) { remotes_.Want(name, role); }
  /// A module of ours has come or gone.
  void OnPresence(const std::string& name, bool present, const std::string& reason) {
    gateway_.OnPresence(name, present, reason);
  }
  /// "ONLINE tcp:HOST:PORT as AGENT", "AWAY why".
  const std::string& State() const { return claim_.state(); }
  bool online() const { return claim_.held(); }
  std::uint64_t dropped() const { return publisher_.dropped(); }

 private:
  Broker::Events BrokerEvents();
  AgentClaim::Hooks ClaimHooks();
  OnNotice Noticing();
  void Notice(const std::string& text);
  void OnHeld();
  void OnLost(const std::string& reason);
  void OnPacket(const Packet& packet);
  void OnReceipt(const Broker::Events::Receipt& receipt);

  vm::Scheduler& clock_;
  const MqttConfig config_;
  const AgentTopics topics_;
  const Hooks hooks_;
  vm::Time notices_since_{0};
  int notices_ = 0;
  // Each uses those above it.
  const std::unique_ptr<Broker> broker_;
  AgentClaim claim_;
  Publisher publisher_;
  LocalGateway gateway_;
  RemoteModules remotes_;
};

}  // namespace am::mqtt
