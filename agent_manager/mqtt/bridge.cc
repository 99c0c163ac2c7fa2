#include "agent_manager/mqtt/bridge.h"

#include <utility>

#include "vm_protocol/core/utf8.h"

namespace am::mqtt {

using Kind = Topic::Kind;

Bridge::Bridge(vm::Scheduler& clock, Hub& hub, MqttConfig config, Hooks hooks,
               const Connect& connect)
    : clock_(clock),
      config_(std::move(config)),
      topics_{config_.root, config_.agent},
      hooks_(std::move(hooks)),
      broker_(connect(AgentClaim::Will(config_), BrokerEvents())),
      claim_(*broker_, config_, ClaimHooks()),
      publisher_(*broker_, claim_, Noticing()),
      gateway_(hub, config_, *broker_, publisher_, Noticing()),
      remotes_(clock, hub, config_, *broker_, claim_, publisher_, Noticing()) {
  hooks_.on_state(claim_.state());
  publisher_.SetValue(topics_.Path(Kind::kState), AgentClaim::kOnline);
  publisher_.SetValue(topics_.Path(Kind::kHub), claim_.id());
  gateway_.ShowModules();
}

Broker::Events Bridge::BrokerEvents() {
  return {.on_online = [this] { claim_.Begin(); },
          .on_lost = [this](const std::string& reason) { OnLost(reason); },
          .on_packet = [this](const Packet& packet) { OnPacket(packet); },
          .on_receipt = [this](const Broker::Events::Receipt& receipt) { OnReceipt(receipt); }};
}

AgentClaim::Hooks Bridge::ClaimHooks() {
  return {.on_held = [this] { OnHeld(); },
          .on_contested = [this] { publisher_.SetValue(topics_.Path(Kind::kHub), claim_.id()); },
          .on_state = hooks_.on_state};
}

OnNotice Bridge::Noticing() {
  return [this](const std::string& text) { Notice(text); };
}

void Bridge::Notice(const std::string& text) {
  // A flood of bad packets must not become a flood of notices.
  if (clock_.Now() - notices_since_ > std::chrono::seconds(1)) {
    notices_since_ = clock_.Now();
    notices_ = 0;
  }
  if (++notices_ <= kNoticesPerSecond) hooks_.on_notice("mqtt: " + vm::ShownUtf8(text));
}

void Bridge::OnHeld() {
  gateway_.SubscribeToCommands();
  publisher_.PublishAllValues();
  remotes_.Follow();
}

void Bridge::OnLost(const std::string& reason) {
  publisher_.Lost();
  claim_.Lost(reason);
  remotes_.Lost(reason);
}

void Bridge::OnPacket(const Packet& packet) {
  const auto topic = ParseTopic(config_.root, packet.topic);
  if (!topic) return gateway_.Refuse(packet, "Error", topic.error());
  if (topic->agent != config_.agent) return remotes_.OnPacket(*topic, packet);
  if (claim_.OnPacket(*topic, packet)) return;
  if (topic->kind == Kind::kReply) return remotes_.OnReply(packet);
  gateway_.OnCommand(*topic, packet);
}

void Bridge::OnReceipt(const Broker::Events::Receipt& receipt) {
  const auto about = publisher_.OnReceipt(receipt);
  if (about && about->receiver != 0) remotes_.OnReceipt(about->receiver, about->bytes, receipt);
}

}  // namespace am::mqtt
