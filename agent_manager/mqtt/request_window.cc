#include "agent_manager/mqtt/request_window.h"

#include <utility>

#include "agent_manager/routing/outbox.h"
#include "vm_protocol/runtime/credentials.h"

namespace am::mqtt {

using vm::Command;
using vm::Message;
using Kind = Topic::Kind;

namespace {

// A little longer than the hub waits for an answer.
constexpr vm::Time kForgetAfter = std::chrono::seconds(125);

/// What a message that waits counts for; a question without a value takes room, too.
std::size_t BytesOf(const Message& message) {
  return sizeof(Message) + message.slot.size() + message.value.size();
}

}  // namespace

RequestWindow::RequestWindow(vm::Scheduler& clock, Publisher& publisher, const AgentTopics& ours,
                             const std::string& name, PeerKey receiver)
    : clock_(clock),
      publisher_(publisher),
      ours_(ours),
      name_(name),
      receiver_(receiver),
      secret_(vm::MakeNonce().substr(0, 16)) {}

bool RequestWindow::Send(const Message& message) {
  std::erase_if(unanswered_, [&](const auto& entry) {
    return clock_.Now() - entry.second.asked > kForgetAfter;
  });
  if (message.tag.empty() || (waiting_.empty() && unanswered_.size() < kMaxUnanswered))
    return Publish(message);
  bytes_ += BytesOf(message);
  waiting_.push_back(message);
  return true;
}

bool RequestWindow::SendWaiting() {
  while (!waiting_.empty() && unanswered_.size() < kMaxUnanswered) {
    Message message = std::move(waiting_.front());
    waiting_.pop_front();
    bytes_ -= BytesOf(message);
    if (!Publish(std::move(message))) return false;
  }
  return true;
}

bool RequestWindow::Publish(Message message) {
  auto [agent, module] = SplitRemoteName(name_);
  // A start time (@T) counts on the clock of the hub there, which passes it on to the module.
  if (message.command == Command::kInq && message.slot == "Clock") module = "AM";
  const std::string tag = std::exchange(message.tag, {});
  message.from.clear();
  Packet packet{.topic = AgentTopics{ours_.root, agent}.Path(Kind::kDo, module),
                .payload = vm::FormatMessage(message)};
  if (!tag.empty()) {
    packet.response_topic = ours_.Path(Kind::kReply);
    packet.correlation = secret_ + " " + name_ + " " + tag;
    unanswered_[tag] = {SlotOf(message), clock_.Now()};
  }
  if (!publisher_.PublishCommand(packet, receiver_)) return false;
  bytes_ += Publisher::BytesOf(packet);
  return true;
}

std::optional<Message> RequestWindow::TakeAnswer(const std::string& tag, Message rep) {
  const auto asked = unanswered_.find(tag);
  if (asked == unanswered_.end()) return std::nullopt;
  const std::string& slot = asked->second.slot;
  if (rep.slot == slot || rep.slot == slot + ".error" || rep.slot == "Error")
    unanswered_.erase(asked);  // not a member of a group, before the answer itself
  rep.tag = tag;
  rep.to.clear();
  rep.from.clear();
  return rep;
}

}  // namespace am::mqtt
