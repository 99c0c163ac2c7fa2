// The connection to the broker, and what we publish there.

#include "agent_manager/mqtt/bridge.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "agent_manager/access/pattern.h"
#include "agent_manager/mqtt/bridge_links.h"
#include "vm_protocol/core/utf8.h"
#include "vm_protocol/runtime/credentials.h"

namespace am::mqtt {

using Kind = Topic::Kind;

namespace {

constexpr int kNoticesPerSecond = 10;
const std::string kOnline = "ONLINE", kOffline = "OFFLINE", kLost = "LOST";

}  // namespace

Bridge::Bridge(vm::Scheduler& clock, Hub& hub, MqttConfig config, Hooks hooks,
               const Connect& connect)
    : clock_(clock),
      hub_(hub),
      config_(std::move(config)),
      hooks_(std::move(hooks)),
      nonce_(vm::MakeNonce().substr(0, 16)) {
  Broker::Events events;
  events.on_online = [this] { Claim(); };
  events.on_lost = [this](const std::string& reason) { Lost(reason); };
  events.on_packet = [this](const Packet& packet) { OnPacket(packet); };
  events.on_receipt = [this](const Broker::Events::Receipt& receipt) { OnReceipt(receipt); };
  broker_ = connect({.topic = Path(Kind::kState), .payload = kLost, .retain = true}, events);
  const auto key = hub_.Attach(std::make_unique<GatewayLink>(*this), PeerKind::kClient,
                               config_.role, kName, Dialect::kAuto);
  if (!key) throw std::runtime_error("mqtt: " + key.error().text);
  gateway_ = *key;
  hub_.Subscribe(gateway_, {"*"});
  SetState("AWAY connecting to " + config_.broker);
  for (const PeerStatus& peer : hub_.Status()) {
    if (peer.kind == PeerKind::kModule && hub_.IsReady(peer.name)) live_.insert(peer.name);
  }
  values_[Path(Kind::kState)] = kOnline;
  values_[Path(Kind::kHub)] = nonce_;
  PublishModules();
}

Bridge::~Bridge() {
  *alive_ = false;
  for (const auto& [name, remote] : std::exchange(remotes_, {})) {
    if (remote.key != 0) hub_.Evict(remote.key, "the bridge to the broker has ended");
  }
  hub_.Evict(gateway_, "the bridge to the broker has ended");
  if (online_) broker_->Publish({.topic = Path(Kind::kState), .payload = kOffline, .retain = true});
}

std::string Bridge::Path(Kind kind, const std::string& module, const std::string& slot) const {
  return FormatTopic(config_.root, {kind, config_.agent, module, slot});
}

bool Bridge::Shows(const std::string& module) const {
  return config_.modules.empty() ||
         std::ranges::any_of(config_.modules, [&](const std::string& pattern) {
           return MatchesPattern(pattern, module);
         });
}

void Bridge::SetState(const std::string& state) {
  if (state == state_) return;
  state_ = state;
  hooks_.on_state(state);
}

void Bridge::Notice(const std::string& text) {
  // A flood of bad packets must not become a flood of notices.
  if (clock_.Now() - notices_since_ > std::chrono::seconds(1)) {
    notices_since_ = clock_.Now();
    notices_ = 0;
  }
  if (++notices_ <= kNoticesPerSecond) hooks_.on_notice("mqtt: " + vm::ShownUtf8(text));
}

void Bridge::Claim() {
  claiming_ = true;
  seen_state_.clear();
  seen_hub_.clear();
  broker_->Subscribe(Path(Kind::kHub), true);
  broker_->Subscribe(Path(Kind::kState), true);
  broker_->Subscribe(Path(Kind::kReply), false);
  // When this comes back, what stands there has come before it.
  broker_->Publish({.topic = Path(Kind::kReply), .correlation = nonce_});
}

void Bridge::OnOtherHub(const std::string& hub) {
  if (claiming_) {
    seen_hub_ = hub;
  } else if (online_ && hub != nonce_) {
    // Both have found the name free in the same moment: one of them stays.
    if (hub > nonce_) return Yield();
    PublishValue(Path(Kind::kHub), nonce_);
  }
}

void Bridge::Yield() {
  claiming_ = false;
  broker_->Rest("another hub goes by the name " + config_.agent + " there");
}

void Bridge::Online() {
  claiming_ = false;
  if (seen_state_ == kOnline && !seen_hub_.empty() && seen_hub_ != nonce_) return Yield();
  online_ = true;
  in_flight_.clear();
  in_flight_bytes_ = 0;
  const std::string ours = config_.root + "/" + config_.agent;
  // Commands that stand there retained would be carried out at every connection.
  for (const char* filter : {"/$do/+", "/+/+/set", "/+/+/inq"})
    broker_->Subscribe(ours + filter, false);
  SetState("ONLINE " + config_.broker + " as " + config_.agent);
  for (const auto& [topic, value] : values_) changed_.insert(topic);
  PublishChanged();
  for (const auto& [name, remote] : remotes_) WatchRemote(name);
}

void Bridge::Lost(const std::string& reason) {
  online_ = claiming_ = false;
  in_flight_.clear();
  in_flight_bytes_ = 0;
  SetState("AWAY " + reason);
  std::vector<std::string> names;
  for (const auto& [name, remote] : remotes_) names.push_back(name);
  for (const std::string& name : names) CloseRemote(name, "the broker is away: " + reason);
}

bool Bridge::Publish(const Packet& packet, InFlight about) {
  if (!online_) return false;
  const int number = broker_->Publish(packet);
  if (number == 0) return false;
  about.bytes = packet.topic.size() + packet.payload.size();
  about.topic = packet.topic;
  in_flight_bytes_ += about.bytes;
  if (const auto remote = remotes_.find(about.remote); remote != remotes_.end())
    remote->second.bytes += about.bytes;
  in_flight_[number] = std::move(about);
  return true;
}

void Bridge::OnReceipt(const Broker::Events::Receipt& receipt) {
  const auto found = in_flight_.find(receipt.number);
  if (found == in_flight_.end()) return;
  const InFlight about = std::move(found->second);
  in_flight_.erase(found);
  in_flight_bytes_ -= about.bytes;
  const auto remote = remotes_.find(about.remote);
  if (remote != remotes_.end()) remote->second.bytes -= about.bytes;
  if (!receipt.refusal.empty())
    Notice("the broker refuses '" + about.topic + "': " + receipt.refusal);
  if (remote != remotes_.end() && (receipt.nobody || !receipt.refusal.empty())) {
    CloseRemote(about.remote, receipt.nobody ? "there is no such agent at the broker"
                                             : "the broker refuses it: " + receipt.refusal);
  }
  PublishChanged();
}

void Bridge::PublishValue(const std::string& topic, const std::string& value) {
  const auto known = values_.find(topic);
  const std::size_t before = known == values_.end() ? 0 : topic.size() + known->second.size();
  const std::size_t after = topic.size() + value.size();
  if ((known == values_.end() && values_.size() >= kMaxValues) ||
      value_bytes_ - before + after > kMaxValueBytes) {
    ++dropped_;
    return Notice("more than " + std::to_string(kMaxValues) + " slots or " +
                  std::to_string(kMaxValueBytes) + " bytes, '" + topic + "' is not published");
  }
  value_bytes_ += after - before;
  values_[topic] = value;
  changed_.insert(topic);
  PublishChanged();
}

void Bridge::PublishChanged() {
  while (online_ && !changed_.empty() && in_flight_bytes_ < kMaxInFlightBytes) {
    const std::string topic = *changed_.begin();
    if (!Publish({.topic = topic, .payload = values_[topic], .retain = true}, {})) return;
    changed_.erase(topic);
  }
}

void Bridge::OnPacket(const Packet& packet) {
  const auto topic = ParseTopic(config_.root, packet.topic);
  if (!topic) return Refuse(packet, "Error", topic.error());
  if (topic->agent != config_.agent) return OnRemote(*topic, packet);
  if (topic->kind == Kind::kHub) return OnOtherHub(packet.payload);
  if (topic->kind == Kind::kState) {
    seen_state_ = packet.payload;
    return;
  }
  if (topic->kind == Kind::kReply && claiming_ && packet.correlation == nonce_) return Online();
  if (topic->kind == Kind::kReply) return OnReply(packet);
  OnCommand(*topic, packet);
}

void Bridge::Refuse(const Packet& packet, const std::string& slot, const vm::Error& error) {
  const std::string text = vm::FormatError(error);
  Notice("refused '" + std::string(vm::CutUtf8(packet.topic, 200)) + "': " + text);
  if (packet.response_topic.empty()) return;
  Publish({.topic = packet.response_topic,
           .payload = "rep " + slot + (slot == "Error" ? "" : ".error") + " = " + text,
           .correlation = packet.correlation},
          {});
}

}  // namespace am::mqtt
