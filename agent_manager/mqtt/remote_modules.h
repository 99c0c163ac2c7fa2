#pragma once

#include <map>
#include <memory>
#include <string>

#include "agent_manager/mqtt/request_window.h"
#include "agent_manager/routing/hub.h"

namespace am::mqtt {

/// The modules of other agents that somebody here speaks to or wants to hear. Each is a peer of the
/// hub, @AGENT/MODULE, of kind kRemote, so that requests, limits, clocks and endings are what they
/// are for any peer. It follows the module's reports and presence at the broker, and the peer
/// leaves when the module, its agent or the broker is gone. A module that a peer is subscribed to
/// comes back.
///
/// Ownership: its peers leave the hub with it; borrows everything it is given.
///
/// Thread: the scheduler's.
///
/// Limits: kMaxRemotes, and for guests together a share of them. One more takes the place of one
/// that nobody is subscribed to: first of one that has never said anything. See RequestWindow.
///
/// Errors: what the broker brings and cannot be used is one notice.
class RemoteModules {
 public:
  static constexpr std::size_t kMaxRemotes = 1024;
  static constexpr std::size_t kShareOfGuests = 4;  ///< a quarter

  RemoteModules(vm::Scheduler& clock, Hub& hub, const MqttConfig& config, Broker& broker,
                const AgentClaim& claim, Publisher& publisher, OnNotice on_notice);
  ~RemoteModules();
  RemoteModules(const RemoteModules&) = delete;

  /// Attaches @AGENT/MODULE if it can be. False: the name is none of another agent.
  vm::Result<bool> Open(const std::string& name, Role asker);
  /// A peer has subscribed to this module: it is followed, and attached while it is there.
  void Want(const std::string& name, Role role);

  /// Our agent's name is held: subscribes to what the modules say.
  void Follow();
  void Lost(const std::string& reason);
  /// What another agent has published.
  void OnPacket(const Topic& topic, const Packet& packet);
  /// An answer at our $reply.
  void OnReply(const Packet& packet);
  /// The broker has taken, or refused, a command of so many bytes to the peer `receiver`.
  void OnReceipt(PeerKey receiver, std::size_t bytes, const Broker::Events::Receipt& receipt);

 private:
  class RemoteLink;

  AgentTopics TopicsOf(const std::string& agent) const { return {config_.root, agent}; }
  struct Remote {
    std::unique_ptr<RequestWindow> window{};  ///< null: it is not there now
    bool of_guest = false;                    ///< a guest was the first to name it
    bool heard = false;                       ///< it has said something
    vm::Time since{0};                        ///< it was named
  };
  Remote& Add(const std::string& name, Role role);
  bool MakeRoom(const std::string& name, Role role);
  void Forget(const std::string& name);
  vm::Result<void> Check(const std::string& name) const;
  void Follow(const std::string& name);
  void Unfollow(const std::string& name);
  void Send(const std::string& name, const vm::Message& message);
  void Close(const std::string& name, const std::string& reason);
  void OnAgentState(const std::string& agent, const std::string& state);
  void OnGone(const std::string& name);
  RequestWindow* WindowOf(const std::string& name) const;
  void CloseIfAway(const RequestWindow& window, bool sent);

  vm::Scheduler& clock_;
  Hub& hub_;
  const MqttConfig& config_;
  Broker& broker_;
  const AgentClaim& claim_;
  Publisher& publisher_;
  const OnNotice on_notice_;
  std::map<std::string, Remote> remotes_;      // by AGENT/MODULE
  std::map<std::string, std::size_t> agents_;  // how many of them are of each agent
};

}  // namespace am::mqtt
