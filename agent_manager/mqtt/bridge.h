#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "agent_manager/mqtt/broker.h"
#include "agent_manager/mqtt/topics.h"
#include "agent_manager/routing/hub.h"

namespace am::mqtt {

/// Joins the hub to a broker. Towards the broker it is the peer @MQTT, which hears every report and
/// says what comes as a command; towards the hub each module of another agent that somebody speaks
/// to is a peer of its own, @AGENT/MODULE, so that requests, limits, clocks and endings are what
/// they are for any peer. docs/scaling.md has the topics (topics.h) and what they mean.
/// A name that another hub has at the broker is left to it.
/// Ownership: its peers leave the hub with it. Thread: the scheduler's.
/// Limits: kMax... below; beyond kMaxInFlightBytes slot values wait (the latest only) and events
///         are dropped and counted; commands to other agents hold their senders by the hub's
///         limits.
/// Errors: what the broker brings and cannot be used is one notice and, where a response topic
///         says where, one answer.
class Bridge {
 public:
  static constexpr std::size_t kMaxValues = 16384;  ///< slots remembered for the broker
  static constexpr std::size_t kMaxValueBytes = 32u << 20;
  static constexpr std::size_t kMaxInFlightBytes = 1u << 20;  ///< not yet taken by the broker
  static constexpr std::size_t kMaxRequests = 4096;           ///< from the broker, unanswered
  static constexpr std::size_t kMaxRemotes = 1024;            ///< modules of others spoken to
  /// Requests to one module of another agent on their way. Brokers drop what they cannot queue, so
  /// the rest waits here.
  static constexpr std::size_t kMaxUnanswered = 64;
  static constexpr const char* kName = "MQTT";  ///< of the peer the broker's commands come from

  using OnNotice = std::function<void(const std::string& text)>;
  using Connect = std::function<std::unique_ptr<Broker>(const Packet& will, Broker::Events events)>;
  struct Hooks {
    OnNotice on_notice;
    OnNotice on_state;  ///< each change of State()
  };
  /// Throws std::runtime_error with a sentence.
  Bridge(vm::Scheduler& clock, Hub& hub, MqttConfig config, Hooks hooks, const Connect& connect);
  ~Bridge();
  Bridge(const Bridge&) = delete;

  /// Attaches @AGENT/MODULE if it can be. False: the name is none of another agent.
  vm::Result<bool> Open(const std::string& name);
  /// Somebody wants to hear this module of another agent, now and whenever it is there.
  void Want(const std::string& name);
  /// A module of ours has come or gone.
  void OnPresence(const std::string& name, bool present, const std::string& reason);
  /// "ONLINE tcp:HOST:PORT as AGENT", "AWAY why".
  const std::string& State() const { return state_; }
  bool online() const { return online_; }
  std::uint64_t dropped() const { return dropped_; }

 private:
  class GatewayLink;
  class RemoteLink;
  struct Unanswered {
    std::string slot;
    vm::Time asked{0};
  };
  struct Remote {     // @AGENT/MODULE
    PeerKey key = 0;  // 0: not there now
    bool wanted = false;
    std::map<std::string, Unanswered> unanswered;  // by the hub's tag
    std::deque<vm::Message> waiting;               // beyond kMaxUnanswered
    std::size_t bytes = 0;                         // not yet taken by the broker, waiting ones too
  };
  struct Request {  // from the broker
    std::string response_topic, correlation, slot;
  };
  struct InFlight {
    std::size_t bytes = 0;
    std::string topic{};
    std::string remote{};  // the one spoken to, if it is a request to another agent
  };

  // bridge.cc: the connection and what is published.
  void Claim();
  void Yield();
  void OnOtherHub(const std::string& hub);
  void Online();
  void Lost(const std::string& reason);
  void OnReceipt(const Broker::Events::Receipt& receipt);
  void OnPacket(const Packet& packet);
  void SetState(const std::string& state);
  void PublishValue(const std::string& topic, const std::string& value);
  void PublishChanged();
  bool Publish(const Packet& packet, InFlight about);
  void Refuse(const Packet& packet, const std::string& slot, const vm::Error& error);
  void Notice(const std::string& text);
  std::string Path(Topic::Kind kind, const std::string& module = "",
                   const std::string& slot = "") const;
  bool Shows(const std::string& module) const;
  // bridge_local.cc: our modules, seen and spoken to from the broker.
  void OnOurMessage(const vm::Message& said);
  void Answer(const vm::Message& rep);
  void OnCommand(const Topic& topic, const Packet& packet);
  void PublishModules();
  // bridge_remote.cc: modules of other agents.
  void SendToRemote(const std::string& name, const vm::Message& message);
  void PublishTo(const std::string& name, Remote& remote, vm::Message message);
  void SendWaiting(const std::string& name);
  void OnReply(const Packet& packet);
  void OnRemote(const Topic& topic, const Packet& packet);
  void CloseRemote(const std::string& name, const std::string& reason);
  void WatchRemote(const std::string& name);
  void RemoteGone(const std::string& name);

  vm::Scheduler& clock_;
  Hub& hub_;
  const MqttConfig config_;
  const Hooks hooks_;
  const std::string nonce_;  // our $hub; and in our correlation data, so that nobody can guess it
  std::unique_ptr<Broker> broker_;
  PeerKey gateway_ = 0;
  bool online_ = false;
  bool claiming_ = false;              // connected, and finding out whether the name is free
  std::string seen_state_, seen_hub_;  // what stands at the broker then
  std::string state_;
  std::set<std::string> live_;                 // our modules that can be spoken to
  std::map<std::string, std::string> values_;  // topic to what is retained there
  std::size_t value_bytes_ = 0;
  std::set<std::string> changed_;      // topics whose value the broker does not have yet
  std::map<int, InFlight> in_flight_;  // by the number of the receipt
  std::size_t in_flight_bytes_ = 0;
  std::map<std::string, Request> requests_;  // by our tag
  unsigned long last_tag_ = 0;
  std::map<std::string, Remote> remotes_;
  std::uint64_t dropped_ = 0;
  vm::Time notices_since_{0};
  int notices_ = 0;
  std::shared_ptr<bool> alive_ = std::make_shared<bool>(true);
};

}  // namespace am::mqtt
