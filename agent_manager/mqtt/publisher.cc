#include "agent_manager/mqtt/publisher.h"

#include <utility>

namespace am::mqtt {

Publisher::Publisher(Broker& broker, const AgentClaim& claim, OnNotice on_notice)
    : broker_(broker), claim_(claim), on_notice_(std::move(on_notice)) {}

void Publisher::SetValue(const std::string& topic, const std::string& value) {
  const auto known = values_.find(topic);
  const std::size_t before = known == values_.end() ? 0 : topic.size() + known->second.size();
  const std::size_t after = topic.size() + value.size();
  if ((known == values_.end() && values_.size() >= kMaxValues) ||
      value_bytes_ - before + after > kMaxValueBytes) {
    ++dropped_;
    return on_notice_("more than " + std::to_string(kMaxValues) + " slots or " +
                      std::to_string(kMaxValueBytes) + " bytes, '" + topic + "' is not published");
  }
  value_bytes_ += after - before;
  values_[topic] = value;
  changed_.insert(topic);
  PublishChanged();
}

void Publisher::PublishEvent(const Packet& packet) { PublishBelow(kMaxInFlightBytes, packet); }

void Publisher::PublishAnswer(const Packet& packet) {
  PublishBelow(kMaxInFlightBytesOfAnswers, packet);
}

bool Publisher::PublishCommand(const Packet& packet, PeerKey receiver) {
  return Publish(packet, receiver);
}

void Publisher::PublishBelow(std::size_t limit, const Packet& packet) {
  if (in_flight_bytes_ >= limit || !Publish(packet)) ++dropped_;
}

bool Publisher::Publish(const Packet& packet, PeerKey receiver) {
  if (!claim_.held()) return false;
  const int number = broker_.Publish(packet);
  if (number == 0) return false;
  InFlight about{BytesOf(packet), packet.topic, receiver};
  in_flight_bytes_ += about.bytes;
  in_flight_.emplace(number, std::move(about));
  return true;
}

void Publisher::PublishAllValues() {
  for (const auto& [topic, value] : values_) changed_.insert(topic);
  PublishChanged();
}

void Publisher::PublishChanged() {
  while (claim_.held() && !changed_.empty() && in_flight_bytes_ < kMaxInFlightBytes) {
    const std::string topic = *changed_.begin();
    if (!Publish({.topic = topic, .payload = values_[topic], .retain = true})) return;
    changed_.erase(topic);
  }
}

void Publisher::Lost() {
  in_flight_.clear();
  in_flight_bytes_ = 0;
}

std::optional<Publisher::InFlight> Publisher::OnReceipt(const Broker::Events::Receipt& receipt) {
  const auto found = in_flight_.lower_bound(receipt.number);
  if (found == in_flight_.end() || found->first != receipt.number) return std::nullopt;
  InFlight about = std::move(found->second);
  in_flight_.erase(found);
  in_flight_bytes_ -= about.bytes;
  if (!receipt.refusal.empty())
    on_notice_("the broker refuses '" + about.topic + "': " + receipt.refusal);
  PublishChanged();
  return about;
}

}  // namespace am::mqtt
