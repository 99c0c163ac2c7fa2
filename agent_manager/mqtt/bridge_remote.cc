// Modules of other agents, as peers of the hub.

#include <algorithm>
#include <utility>

#include "agent_manager/mqtt/bridge.h"
#include "agent_manager/mqtt/bridge_links.h"
#include "vm_protocol/core/utf8.h"

namespace am::mqtt {

using vm::Command;
using vm::Errc;
using vm::Fail;
using vm::Message;
using vm::Result;
using Kind = Topic::Kind;

namespace {

// A little longer than the hub waits for an answer.
constexpr vm::Time kForgetAfter = std::chrono::seconds(125);

}  // namespace

Result<bool> Bridge::Open(const std::string& name) {
  const auto [agent, module] = SplitRemoteName(name);
  if (agent.empty()) return false;
  if (agent == config_.agent)
    return Fail(Errc::kUnknownModule, "@" + name + " is one of our own: to @" + module);
  if (!online_)
    return Fail(Errc::kUnavailable, "@" + name + " cannot be reached, the broker is " + state_);
  if (const auto known = remotes_.find(name); known != remotes_.end() && known->second.key != 0)
    return true;
  if (!remotes_.contains(name) && remotes_.size() >= kMaxRemotes)
    return Fail(Errc::kLimit,
                "more than " + std::to_string(kMaxRemotes) + " modules of other agents");
  const bool watched = remotes_.contains(name);
  const auto key = hub_.Attach(std::make_unique<RemoteLink>(*this, name), PeerKind::kRemote,
                               config_.role, name, Dialect::kModern);
  if (!key) return std::unexpected(key.error());
  remotes_[name].key = *key;
  if (!watched) WatchRemote(name);
  return true;
}

void Bridge::Want(const std::string& name) {
  const auto opened = Open(name);
  if (opened && !*opened) return;
  if (!remotes_.contains(name) && remotes_.size() >= kMaxRemotes)
    return Notice("@" + name + " is not heard: " + opened.error().text);
  remotes_[name].wanted = true;
}

void Bridge::WatchRemote(const std::string& name) {
  const auto [agent, module] = SplitRemoteName(name);
  const auto filter = [&](Kind kind, const std::string& slot) {
    return FormatTopic(config_.root, {kind, agent, module, slot});
  };
  broker_->Subscribe(filter(Kind::kSlot, "+"), false);  // what it says from now on
  broker_->Subscribe(filter(Kind::kState, ""), true);
  broker_->Subscribe(filter(Kind::kModuleState, ""), true);
}

void Bridge::RemoteGone(const std::string& name) {
  const auto found = remotes_.find(name);
  if (found == remotes_.end()) return;
  found->second.key = 0;
  found->second.bytes = 0;
  found->second.unanswered.clear();
  found->second.waiting.clear();
  std::erase_if(in_flight_, [&](const auto& entry) {
    if (entry.second.remote != name) return false;
    in_flight_bytes_ -= entry.second.bytes;
    return true;
  });
  if (found->second.wanted) return;
  remotes_.erase(found);
  const auto [agent, module] = SplitRemoteName(name);
  broker_->Unsubscribe(FormatTopic(config_.root, {Kind::kSlot, agent, module, "+"}));
  broker_->Unsubscribe(FormatTopic(config_.root, {Kind::kModuleState, agent, module, ""}));
  const bool last = std::ranges::none_of(remotes_, [&, ours = agent](const auto& other) {
    return SplitRemoteName(other.first).agent == ours;
  });
  if (last) broker_->Unsubscribe(FormatTopic(config_.root, {Kind::kState, agent, "", ""}));
}

void Bridge::CloseRemote(const std::string& name, const std::string& reason) {
  const auto found = remotes_.find(name);
  if (found == remotes_.end() || found->second.key == 0) return;
  hub_.Leave(found->second.key, reason);  // its link tells RemoteGone
}

void Bridge::SendToRemote(const std::string& name, const Message& message) {
  if (message.command == Command::kRep || message.command == Command::kTell)
    return Notice("@" + name + " is not sent '" +
                  std::string(vm::CutUtf8(vm::FormatMessage(message), 60)) +
                  "': it hears reports by subscribing to them");
  const auto found = remotes_.find(name);
  if (found == remotes_.end()) return;
  Remote& remote = found->second;
  std::erase_if(remote.unanswered, [&](const auto& entry) {
    return clock_.Now() - entry.second.asked > kForgetAfter;
  });
  if (message.tag.empty() || (remote.waiting.empty() && remote.unanswered.size() < kMaxUnanswered))
    return PublishTo(name, remote, message);
  remote.bytes += message.value.size();
  remote.waiting.push_back(message);
}

void Bridge::SendWaiting(const std::string& name) {
  while (true) {
    const auto found = remotes_.find(name);
    if (found == remotes_.end() || found->second.waiting.empty() ||
        found->second.unanswered.size() >= kMaxUnanswered)
      return;
    Remote& remote = found->second;
    Message message = std::move(remote.waiting.front());
    remote.waiting.pop_front();
    remote.bytes -= message.value.size();
    PublishTo(name, remote, std::move(message));
  }
}

void Bridge::PublishTo(const std::string& name, Remote& remote, Message message) {
  auto [agent, module] = SplitRemoteName(name);
  // A start time (@T) counts on the clock of the hub there, which passes it on to the module.
  if (message.command == Command::kInq && message.slot == "Clock") module = "AM";
  const std::string tag = std::exchange(message.tag, {});
  message.from.clear();
  Packet packet{.topic = FormatTopic(config_.root, {Kind::kDo, agent, module, ""}),
                .payload = vm::FormatMessage(message)};
  if (!tag.empty()) {
    packet.response_topic = Path(Kind::kReply);
    packet.correlation = nonce_ + " " + name + " " + tag;
    remote.unanswered[tag] = {SlotOf(message), clock_.Now()};
  }
  if (Publish(packet, {.remote = name})) return;
  clock_.Post([this, alive = alive_, name] {
    if (*alive) CloseRemote(name, "the broker is " + state_);
  });
}

void Bridge::OnReply(const Packet& packet) {
  std::string_view rest = packet.correlation;
  const auto word = [&rest] {
    const std::size_t end = std::min(rest.find(' '), rest.size());
    const std::string_view taken = rest.substr(0, end);
    rest.remove_prefix(std::min(end + 1, rest.size()));
    return std::string(taken);
  };
  const std::string nonce = word(), name = word(), tag = word();
  const auto remote = remotes_.find(name);
  auto rep = vm::ParseMessage(packet.payload);
  if (nonce != nonce_ || !vm::IsTag(tag) || !rep || rep->command != Command::kRep)
    return Notice("an answer nobody has asked for: '" + packet.payload.substr(0, 60) + "'");
  if (remote == remotes_.end() || remote->second.key == 0) return;  // too late
  const auto asked = remote->second.unanswered.find(tag);
  if (asked == remote->second.unanswered.end()) return;
  const std::string& slot = asked->second.slot;
  if (rep->slot == slot || rep->slot == slot + ".error" || rep->slot == "Error")
    remote->second.unanswered.erase(asked);  // not a member of a group, before the answer itself
  rep->tag = tag;
  rep->to.clear();
  rep->from.clear();
  hub_.Receive(remote->second.key, std::move(*rep));
  SendWaiting(name);
}

void Bridge::OnRemote(const Topic& topic, const Packet& packet) {
  if (topic.kind == Kind::kState) {
    std::vector<std::string> names;
    for (const auto& [name, remote] : remotes_) {
      if (SplitRemoteName(name).agent == topic.agent) names.push_back(name);
    }
    for (const std::string& name : names) {
      if (packet.payload != "ONLINE") {
        CloseRemote(name, "the agent " + topic.agent + " is " + packet.payload.substr(0, 40));
      } else if (remotes_[name].wanted) {
        static_cast<void>(Open(name));
      }
    }
    return;
  }
  const std::string name = topic.agent + "/" + topic.module;
  const auto remote = remotes_.find(name);
  if (remote == remotes_.end()) return;
  if (topic.kind == Kind::kModuleState) {
    if (packet.payload == "LIVE") {
      if (remote->second.wanted) static_cast<void>(Open(name));
    } else {
      CloseRemote(name, packet.payload.substr(0, 200));
    }
    return;
  }
  if (remote->second.key == 0 || (topic.kind != Kind::kSlot && topic.kind != Kind::kTell)) return;
  const Message said =
      topic.kind == Kind::kSlot ? vm::Rep(topic.slot, packet.payload) : vm::Tell(packet.payload);
  if (!vm::IsValid(said))
    return Notice("'" + packet.topic + "' is not one line of UTF-8 text, it is not passed on");
  hub_.Receive(remote->second.key, said);
}

}  // namespace am::mqtt
