#include "agent_manager/mqtt/publisher.h"

#include <utility>

namespace am::mqtt {

Publisher::Publisher(Broker& broker, const AgentClaim& claim, OnNotice on_notice)
    : broker_(broker), claim_(claim), on_notice_(std::move(on_notice)) {}

/// `sign`: 1 for a value that comes, -1 for one that goes.
void Publisher::Count(const std::string& topic, const Value& value, int sign) {
  const auto count = [&](Room& room) {
    room.values += static_cast<std::size_t>(sign);
    room.bytes += static_cast<std::size_t>(sign) * (topic.size() + value.text.size());
  };
  count(all_);
  if (value.whose == Whose::kGuests) count(guests_);
}

void Publisher::SetValue(const std::string& topic, const std::string& text, Whose whose) {
  const Value value{text, whose};
  const auto [known, added] = values_.try_emplace(topic);
  const Value before = added ? Value{} : std::move(known->second);
  if (!added) Count(topic, before, -1);
  Count(topic, value, 1);
  const auto exceeds = [](const Room& room, std::size_t share) {
    return room.values > kMaxValues / share || room.bytes > kMaxValueBytes / share;
  };
  if (exceeds(all_, 1) || (whose == Whose::kGuests && exceeds(guests_, kShareOfGuests))) {
    Count(topic, value, -1);
    if (added) {
      values_.erase(known);
    } else {
      Count(topic, before, 1);
      known->second = before;
    }
    ++dropped_;
    const std::size_t share = whose == Whose::kGuests ? kShareOfGuests : 1;
    return on_notice_("more than " + std::to_string(kMaxValues / share) + " slots or " +
                      std::to_string(kMaxValueBytes / share) + " bytes" +
                      (whose == Whose::kGuests ? " of guests" : "") + ", '" + topic +
                      "' is not published");
  }
  known->second = value;
  changed_.insert(topic);
  PublishChanged();
}

void Publisher::ForgetValues(const std::string& prefix, const std::string& kept) {
  for (auto at = values_.lower_bound(prefix);
       at != values_.end() && at->first.starts_with(prefix);) {
    if (at->first == kept) {
      ++at;
      continue;
    }
    Count(at->first, at->second, -1);
    if (changed_.size() < 2 * kMaxValues) changed_.insert(at->first);
    at = values_.erase(at);
  }
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
    // A retained message without a payload is one the broker forgets (MQTT 3.1.1, 3.3.1.3).
    const auto known = values_.find(topic);
    const std::string payload = known == values_.end() ? "" : known->second.text;
    if (!Publish({.topic = topic, .payload = payload, .retain = true})) return;
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
