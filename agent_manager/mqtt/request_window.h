#pragma once

#include <deque>
#include <map>
#include <optional>
#include <string>

#include "agent_manager/mqtt/publisher.h"
#include "agent_manager/mqtt/topics.h"
#include "vm_protocol/core/message.h"
#include "vm_protocol/core/scheduler.h"

namespace am::mqtt {

/// Publishes what is said to one module of another agent. Brokers drop what they cannot queue, so
/// at most kMaxUnanswered requests are on their way and the rest waits here, in order. A request
/// whose first answer has come, if only a member of a group, is no longer on its way.
///
/// Ownership: borrows the clock and the publisher; lives as long as the module's peer.
///
/// Thread: the scheduler's.
///
/// Limits: bytes() is the peer's backlog, by which the hub holds the senders.
///
/// Errors: false from Send and SendWaiting means that the broker is away; the window is then of no
/// more use.
class RequestWindow {
 public:
  static constexpr std::size_t kMaxUnanswered = 64;
  /// `ours`: where answers come to. `name`: AGENT/MODULE, which is `receiver` at the hub.
  RequestWindow(vm::Scheduler& clock, Publisher& publisher, const AgentTopics& ours,
                const std::string& name, PeerKey receiver);
  RequestWindow(const RequestWindow&) = delete;

  [[nodiscard]] bool Send(const vm::Message& message);
  /// After an answer.
  [[nodiscard]] bool SendWaiting();
  /// The broker has acknowledged so much.
  void Acknowledged(std::size_t bytes) { bytes_ -= bytes; }
  /// What a correlation must begin with.
  const std::string& secret() const { return secret_; }
  /// The answer with the hub's tag; nothing if nobody waits for it.
  std::optional<vm::Message> TakeAnswer(const std::string& tag, vm::Message rep);

  PeerKey receiver() const { return receiver_; }
  /// Not yet acknowledged, with what waits.
  std::size_t bytes() const { return bytes_; }

 private:
  struct Request {
    std::string slot;
    vm::Time asked{0};
    bool answered = false;  ///< something has come, if only a member of a group
  };
  void ForgetOld();
  bool Publish(vm::Message message);

  vm::Scheduler& clock_;
  Publisher& publisher_;
  const AgentTopics ours_;
  const std::string name_;
  const PeerKey receiver_;
  const std::string secret_;
  std::map<std::string, Request> requests_;  // by the hub's tag
  std::size_t silent_ = 0;                   // of them, not answered at all
  std::deque<vm::Message> waiting_;
  std::size_t bytes_ = 0;
};

}  // namespace am::mqtt
