#include "agent_manager/mqtt/remote_modules.h"

#include <algorithm>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include "vm_protocol/core/utf8.h"

namespace am::mqtt {

using vm::Command;
using vm::Errc;
using vm::Fail;
using vm::Message;
using vm::Result;
using Kind = Topic::Kind;

namespace {

/// What comes from the broker, as it may stand in a line of ours.
std::string Shown(std::string_view payload, std::size_t max_bytes) {
  return vm::ShownUtf8(vm::CutUtf8(payload, max_bytes));
}

}  // namespace

/// What a module of another agent is sent.
class RemoteModules::RemoteLink final : public Link {
 public:
  RemoteLink(RemoteModules& modules, std::string name)
      : modules_(modules), name_(std::move(name)) {}
  void Send(const Outgoing& outgoing) override { modules_.Send(name_, outgoing.message()); }
  void Close() override { modules_.OnGone(name_); }
  std::size_t backlog_bytes() const override {
    const RequestWindow* const window = modules_.WindowOf(name_);
    return window == nullptr ? 0 : window->bytes();
  }

 private:
  RemoteModules& modules_;
  const std::string name_;
};

RemoteModules::RemoteModules(vm::Scheduler& clock, Hub& hub, const MqttConfig& config,
                             Broker& broker, const AgentClaim& claim, Publisher& publisher,
                             OnNotice on_notice)
    : clock_(clock),
      hub_(hub),
      config_(config),
      broker_(broker),
      claim_(claim),
      publisher_(publisher),
      on_notice_(std::move(on_notice)) {}

RemoteModules::~RemoteModules() {
  for (const auto& [name, remote] : std::exchange(remotes_, {})) {
    if (remote.window) hub_.Evict(remote.window->receiver(), "the bridge to the broker has ended");
  }
}

RequestWindow* RemoteModules::WindowOf(const std::string& name) const {
  const auto found = remotes_.find(name);
  return found == remotes_.end() ? nullptr : found->second.window.get();
}

/// False if no other module than those there are can be spoken to or followed.
bool RemoteModules::MakeRoom(const std::string& name, Role role) {
  if (remotes_.contains(name)) return true;
  const bool guest = role == Role::kGuest;
  const auto in_share = [guest](const auto& entry) { return !guest || entry.second.of_guest; };
  const auto there = static_cast<std::size_t>(std::ranges::count_if(remotes_, in_share));
  if (there < kMaxRemotes / (guest ? kShareOfGuests : 1)) return true;
  const auto rank = [](const Remote& remote) {
    return std::tuple(remote.window != nullptr, remote.heard, remote.since);
  };
  auto least = remotes_.end();
  for (auto at = remotes_.begin(); at != remotes_.end(); ++at) {
    if (!in_share(*at) || hub_.HasSubscriber(at->first)) continue;
    if (least == remotes_.end() || rank(at->second) < rank(least->second)) least = at;
  }
  if (least == remotes_.end()) return false;
  Forget(std::string(least->first));
  return true;
}

void RemoteModules::Forget(const std::string& name) {
  const auto gone = remotes_.extract(name);
  if (gone.mapped().window)
    hub_.Leave(gone.mapped().window->receiver(), "others are spoken to in its place");
  Unfollow(name);
}

/// Whether such a module can be anywhere. REQUIRES: the name is AGENT/MODULE.
Result<void> RemoteModules::Check(const std::string& name) const {
  const auto [agent, module] = SplitRemoteName(name);
  if (agent == config_.agent)
    return Fail(Errc::kUnknownModule, "@" + name + " is one of our own: to @" + module);
  return {};
}

Result<bool> RemoteModules::Open(const std::string& name, Role asker) {
  if (SplitRemoteName(name).agent.empty()) return false;
  if (const auto checked = Check(name); !checked) return std::unexpected(checked.error());
  if (!claim_.held())
    return Fail(Errc::kUnavailable,
                "@" + name + " cannot be reached, the broker is " + claim_.state());
  if (WindowOf(name) != nullptr) return true;
  if (!MakeRoom(name, asker))
    return Fail(Errc::kLimit,
                "more than " + std::to_string(kMaxRemotes) + " modules of other agents");
  const auto peer = hub_.Attach(std::make_unique<RemoteLink>(*this, name), PeerKind::kRemote,
                                config_.role, name, Dialect::kModern);
  if (!peer) return std::unexpected(peer.error());
  Add(name, asker).window =
      std::make_unique<RequestWindow>(clock_, publisher_, TopicsOf(config_.agent), name, *peer);
  return true;
}

void RemoteModules::Want(const std::string& name, Role role) {
  if (SplitRemoteName(name).agent.empty()) return;
  auto wanted = Check(name);
  if (wanted && !MakeRoom(name, role))
    wanted = Fail(Errc::kLimit, "too many modules of other agents are");
  if (!wanted) return on_notice_("@" + name + " is not heard: " + wanted.error().text);
  Add(name, role);  // what the broker keeps of its presence attaches it
}

RemoteModules::Remote& RemoteModules::Add(const std::string& name, Role role) {
  const auto [entry, added] = remotes_.try_emplace(name);
  if (added) {
    ++agents_[SplitRemoteName(name).agent];
    entry->second.of_guest = role == Role::kGuest;
    entry->second.since = clock_.Now();
    if (claim_.held()) Follow(name);
  }
  return entry->second;
}

void RemoteModules::Follow() {
  for (const auto& [name, remote] : remotes_) Follow(name);
}

void RemoteModules::Follow(const std::string& name) {
  const auto [agent, module] = SplitRemoteName(name);
  const AgentTopics topics = TopicsOf(agent);
  broker_.Subscribe(topics.Path(Kind::kSlot, module, "+"), false);  // what it says from now on
  broker_.Subscribe(topics.Path(Kind::kState), true);
  broker_.Subscribe(topics.Path(Kind::kModuleState, module), true);
}

void RemoteModules::Unfollow(const std::string& name) {
  const auto [agent, module] = SplitRemoteName(name);
  const AgentTopics topics = TopicsOf(agent);
  broker_.Unsubscribe(topics.Path(Kind::kSlot, module, "+"));
  broker_.Unsubscribe(topics.Path(Kind::kModuleState, module));
  if (--agents_[agent] > 0) return;
  agents_.erase(agent);
  broker_.Unsubscribe(topics.Path(Kind::kState));
}

void RemoteModules::OnGone(const std::string& name) {
  const auto found = remotes_.find(name);
  if (found == remotes_.end()) return;
  found->second.window.reset();
  if (hub_.HasSubscriber(name)) return;
  remotes_.erase(found);
  Unfollow(name);
}

void RemoteModules::Close(const std::string& name, const std::string& reason) {
  const RequestWindow* const window = WindowOf(name);
  if (window != nullptr) hub_.Leave(window->receiver(), reason);  // its link tells OnGone
}

void RemoteModules::Lost(const std::string& reason) {
  for (const auto& [name, remote] : remotes_) Close(name, "the broker is away: " + reason);
}

void RemoteModules::Send(const std::string& name, const Message& message) {
  if (message.command == Command::kRep || message.command == Command::kTell)
    return on_notice_("@" + name + " is not sent '" +
                      std::string(vm::CutUtf8(vm::FormatMessage(message), 60)) +
                      "': it hears reports by subscribing to them");
  RequestWindow* const window = WindowOf(name);
  if (window != nullptr) CloseIfAway(*window, window->Send(message));
}

void RemoteModules::CloseIfAway(const RequestWindow& window, bool sent) {
  if (!sent) hub_.Leave(window.receiver(), "the broker is " + claim_.state());
}

void RemoteModules::OnReceipt(PeerKey receiver, std::size_t bytes,
                              const Broker::Events::Receipt& receipt) {
  RequestWindow* const window = WindowOf(hub_.directory().NameOf(receiver));
  if (window == nullptr || window->receiver() != receiver) return;  // it has gone meanwhile
  window->Acknowledged(bytes);
  if (receipt.nobody) {
    hub_.Leave(receiver, "there is no such agent at the broker");
  } else if (!receipt.refusal.empty()) {
    hub_.Leave(receiver, "the broker refuses it: " + receipt.refusal);
  }
}

void RemoteModules::OnReply(const Packet& packet) {
  std::string_view rest = packet.correlation;
  const auto word = [&rest] {
    const std::size_t end = std::min(rest.find(' '), rest.size());
    const std::string_view taken = rest.substr(0, end);
    rest.remove_prefix(std::min(end + 1, rest.size()));
    return std::string(taken);
  };
  const std::string secret = word(), name = word(), tag = word();
  RequestWindow* const window = WindowOf(name);
  auto rep = vm::ParseMessage(packet.payload);
  if ((window != nullptr && secret != window->secret()) || !vm::IsTag(tag) || !rep ||
      rep->command != Command::kRep)
    return on_notice_("an answer nobody has asked for: '" +
                      std::string(vm::CutUtf8(packet.payload, 60)) + "'");
  if (window == nullptr) return;  // too late
  auto answer = window->TakeAnswer(tag, std::move(*rep));
  if (!answer) return;
  remotes_.at(name).heard = true;
  hub_.Receive(window->receiver(), std::move(*answer));
  CloseIfAway(*window, window->SendWaiting());
}

void RemoteModules::OnAgentState(const std::string& agent, const std::string& state) {
  std::vector<std::string> names;
  for (const auto& [name, remote] : remotes_) {
    if (SplitRemoteName(name).agent == agent) names.push_back(name);
  }
  for (const std::string& name : names) {
    if (state != AgentClaim::kOnline) {
      Close(name, "the agent " + agent + " is " + Shown(state, 40));
    } else if (hub_.HasSubscriber(name)) {
      static_cast<void>(Open(name, config_.role));
    }
  }
}

void RemoteModules::OnPacket(const Topic& topic, const Packet& packet) {
  if (topic.kind == Kind::kState) return OnAgentState(topic.agent, packet.payload);
  const std::string name = topic.agent + "/" + topic.module;
  const auto found = remotes_.find(name);
  if (found == remotes_.end()) return;
  if (topic.kind == Kind::kModuleState) {
    if (packet.payload != "LIVE") {
      Close(name, Shown(packet.payload, 200));
    } else if (hub_.HasSubscriber(name)) {
      static_cast<void>(Open(name, config_.role));
    }
    return;
  }
  if (topic.kind != Kind::kSlot && topic.kind != Kind::kTell) return;
  // What speaks is there.
  if (WindowOf(name) == nullptr && hub_.HasSubscriber(name))
    static_cast<void>(Open(name, config_.role));
  const RequestWindow* const window = WindowOf(name);
  if (window == nullptr) return;
  const Message said =
      topic.kind == Kind::kSlot ? vm::Rep(topic.slot, packet.payload) : vm::Tell(packet.payload);
  if (!vm::IsValid(said))
    return on_notice_("'" + packet.topic + "' is not one line of UTF-8 text, it is not passed on");
  found->second.heard = true;
  hub_.Receive(window->receiver(), said);
}

}  // namespace am::mqtt
