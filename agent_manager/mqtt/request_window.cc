#include "agent_manager/mqtt/request_window.h"

#include <utility>

#include "agent_manager/routing/outbox.h"
#include "agent_manager/routing/own_names.h"
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
  ForgetOld();
  if (message.tag.empty() || (waiting_.empty() && silent_ < kMaxUnanswered))
    return Publish(message);
  bytes_ += BytesOf(message);
  waiting_.push_back(message);
  return true;
}

void RequestWindow::ForgetOld() {
  std::erase_if(requests_, [this](const auto& entry) {
    const bool old = clock_.Now() - entry.second.asked > kForgetAfter;
    if (old && !entry.second.answered) --silent_;
    return old;
  });
}

bool RequestWindow::SendWaiting() {
  while (!waiting_.empty() && silent_ < kMaxUnanswered) {
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
  if (message.command == Command::kInq && message.slot == "Clock") module = own_name::kHub;
  const std::string tag = std::exchange(message.tag, {});
  message.from.clear();
  Packet packet{.topic = AgentTopics{ours_.root, agent}.Path(Kind::kDo, module),
                .payload = vm::FormatMessage(message)};
  if (!tag.empty()) {
    packet.response_topic = ours_.Path(Kind::kReply);
    packet.correlation = secret_ + " " + name_ + " " + tag;
    if (requests_.insert_or_assign(tag, Request{SlotOf(message), clock_.Now()}).second) ++silent_;
  }
  if (!publisher_.PublishCommand(packet, receiver_)) return false;
  bytes_ += Publisher::BytesOf(packet);
  return true;
}

std::optional<Message> RequestWindow::TakeAnswer(const std::string& tag, Message rep) {
  const auto asked = requests_.find(tag);
  if (asked == requests_.end()) return std::nullopt;
  if (!std::exchange(asked->second.answered, true)) --silent_;
  // Members of a group come before the answer itself.
  if (rep.slot == asked->second.slot || rep.slot.ends_with(".error") || rep.slot == "Error")
    requests_.erase(asked);
  rep.tag = tag;
  rep.to.clear();
  rep.from.clear();
  return rep;
}

}  // namespace am::mqtt
