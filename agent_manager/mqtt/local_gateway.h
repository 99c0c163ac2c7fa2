#pragma once

#include <map>
#include <set>
#include <string>

#include "agent_manager/mqtt/publisher.h"
#include "agent_manager/mqtt/topics.h"
#include "agent_manager/routing/hub.h"
#include "agent_manager/routing/own_names.h"

namespace am::mqtt {

/// Shows our modules at the broker and carries out what it brings for them. It is one peer of the
/// hub, @MQTT, of the configured role: it hears every report and publishes it, and says each
/// command that comes on $do, set or inq; answers go to the command's response topic.
/// Ownership: the peer leaves the hub with it; borrows the hub, the broker, the publisher.
/// Thread: the scheduler's.
/// Limits: kMax... below. The peer has no backlog: what the broker does not take is the
///         publisher's to bound.
/// Errors: a command that cannot be carried out is one notice and, where there is a response topic
///         that may be answered to, one answer.
class LocalGateway {
 public:
  static constexpr const char* kName = own_name::kBroker;
  /// From the broker, unanswered; beyond them the oldest is answered LIMIT.
  static constexpr std::size_t kMaxRequests = 4096;
  static constexpr std::size_t kMaxResponseTopicBytes = 1024;
  static constexpr std::size_t kMaxCorrelationBytes = 1024;

  /// Throws std::runtime_error if the hub does not take the peer.
  LocalGateway(Hub& hub, const MqttConfig& config, Broker& broker, Publisher& publisher,
               OnNotice on_notice);
  ~LocalGateway();
  LocalGateway(const LocalGateway&) = delete;

  /// Publishes as $modules who is at the hub already.
  void ShowModules();
  /// A peer of the hub has come or gone.
  void OnPresence(const std::string& name, bool present, const std::string& reason);
  /// The name is held: commands may come.
  void SubscribeToCommands();
  void OnCommand(const Topic& topic, const Packet& packet);
  /// `slot`: "Error" if none is known.
  void Refuse(const Packet& packet, const std::string& slot, const vm::Error& error);

 private:
  class GatewayLink;
  struct Request {
    std::string response_topic, correlation, slot;
    bool answered = false;  ///< something has come, if only a member of a group
  };
  void OnOurMessage(const vm::Message& said);
  void Answer(const vm::Message& rep);
  vm::Result<vm::Message> CommandOf(const Topic& topic, const Packet& packet) const;
  vm::Result<void> CheckCommand(const std::string& module, const vm::Message& message) const;
  void Ask(const Packet& packet, const std::string& slot, vm::Message message);
  void ForgetOldest();
  void PublishRefusal(const Request& request, const vm::Error& error);
  bool MayAnswerTo(const std::string& topic) const;
  bool Shows(const std::string& module) const;
  void PublishModules();

  Hub& hub_;
  const MqttConfig& config_;
  const AgentTopics topics_;
  Broker& broker_;
  Publisher& publisher_;
  const OnNotice on_notice_;
  PeerKey peer_ = 0;
  std::set<std::string> live_;                 // our modules that can be spoken to
  std::map<unsigned long, Request> requests_;  // by our tag's number, so the oldest first
  unsigned long last_number_ = 0;
};

}  // namespace am::mqtt
