#include "agent_manager/mqtt/agent_claim.h"

#include <utility>

#include "vm_protocol/runtime/credentials.h"

namespace am::mqtt {

using Kind = Topic::Kind;

namespace {

constexpr std::size_t kIdBytes = 16;
const std::string kOffline = "OFFLINE", kLost = "LOST";

}  // namespace

AgentClaim::AgentClaim(Broker& broker, const MqttConfig& config, Hooks hooks)
    : broker_(broker),
      config_(config),
      topics_{config.root, config.agent},
      hooks_(std::move(hooks)),
      id_(vm::MakeNonce().substr(0, kIdBytes)),
      marker_(vm::MakeNonce().substr(0, kIdBytes)),
      state_("AWAY connecting to " + config.broker) {}

AgentClaim::~AgentClaim() {
  if (held_)
    broker_.Publish({.topic = topics_.Path(Kind::kState), .payload = kOffline, .retain = true});
}

Packet AgentClaim::Will(const MqttConfig& config) {
  return {.topic = AgentTopics{config.root, config.agent}.Path(Kind::kState),
          .payload = kLost,
          .retain = true};
}

void AgentClaim::SetState(const std::string& state) {
  if (state == state_) return;
  state_ = state;
  hooks_.on_state(state);
}

void AgentClaim::Begin() {
  claiming_ = true;
  seen_state_.clear();
  seen_hub_.clear();
  broker_.Subscribe(topics_.Path(Kind::kHub), true);
  broker_.Subscribe(topics_.Path(Kind::kState), true);
  broker_.Subscribe(topics_.Path(Kind::kReply), false);
  // The broker delivers in order: the retained values come before this.
  broker_.Publish({.topic = topics_.Path(Kind::kReply), .correlation = marker_});
}

void AgentClaim::Lost(const std::string& reason) {
  held_ = claiming_ = false;
  SetState("AWAY " + reason);
}

bool AgentClaim::OnPacket(const Topic& topic, const Packet& packet) {
  if (topic.kind == Kind::kHub) {
    OnHub(packet.payload);
  } else if (topic.kind == Kind::kState) {
    seen_state_ = packet.payload;
  } else if (topic.kind == Kind::kReply && claiming_ && packet.correlation == marker_) {
    Decide();
  } else {
    return false;
  }
  return true;
}

void AgentClaim::Decide() {
  claiming_ = false;
  if (seen_state_ == kOnline && !seen_hub_.empty() && seen_hub_ != id_) return Yield();
  held_ = true;
  SetState("ONLINE " + config_.broker + " as " + config_.agent);
  hooks_.on_held();
}

void AgentClaim::OnHub(const std::string& hub) {
  if (claiming_) {
    seen_hub_ = hub;
  } else if (held_ && hub != id_) {
    hub > id_ ? Yield() : hooks_.on_contested();
  }
}

void AgentClaim::Yield() {
  claiming_ = false;
  broker_.Rest("another hub goes by the name " + config_.agent + " there");
}

}  // namespace am::mqtt
