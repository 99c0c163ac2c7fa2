// Our modules, seen and spoken to from the broker.

#include <set>
#include <utility>

#include "agent_manager/mqtt/bridge.h"
#include "agent_manager/mqtt/bridge_links.h"

namespace am::mqtt {

using vm::Command;
using vm::Errc;
using vm::Error;
using vm::Message;
using Kind = Topic::Kind;

namespace {

constexpr std::size_t kMaxCorrelationBytes = 1024;
const std::set<std::string> kInside{"AM", "AM-MCL", "FS-MCL"};
/// Slots of @AM about the connection they are said on, which here is everybody's.
const std::set<std::string> kOfTheConnection{"Name", "Subscribe", "Flow", "Wait"};

}  // namespace

void Bridge::OnPresence(const std::string& name, bool present, const std::string& reason) {
  if (name.find('/') != std::string::npos) return;
  if (present ? !live_.insert(name).second : live_.erase(name) == 0) return;
  if (!Shows(name)) return;
  PublishValue(Path(Kind::kModuleState, name), present ? "LIVE" : "GONE " + reason);
  PublishModules();
}

void Bridge::PublishModules() {
  std::string names;
  for (const auto& group : {kInside, live_}) {
    for (const std::string& name : group) {
      if (Shows(name)) names += (names.empty() ? "" : " ") + name;
    }
  }
  PublishValue(Path(Kind::kModules), names);
}

void Bridge::OnOurMessage(const Message& said) {
  if (said.command != Command::kRep && said.command != Command::kTell) {
    if (said.tag.empty()) return;
    Message rep = vm::Rep(SlotOf(said) + ".error",
                          "UNKNOWN_SLOT the broker has no slots of its own: to @AGENT/MODULE "
                          "reaches others");
    rep.tag = said.tag;
    return hub_.Receive(gateway_, std::move(rep));
  }
  if (!said.tag.empty()) return Answer(said);
  const std::string& from = said.from;
  if ((!kInside.contains(from) && !hub_.IsModule(from)) || !Shows(from)) return;
  const bool error = said.slot == "Error" || said.slot.ends_with(".error");
  if (said.command == Command::kRep && !error)
    return PublishValue(Path(Kind::kSlot, from, said.slot), said.value);
  Message bare = said;
  bare.from.clear();
  if (in_flight_bytes_ >= kMaxInFlightBytes ||
      !Publish({.topic = Path(error ? Kind::kError : Kind::kTell, from),
                .payload = error ? vm::FormatMessage(bare) : said.value},
               {}))
    ++dropped_;
}

void Bridge::Answer(const Message& rep) {
  const auto found = requests_.find(rep.tag);
  if (found == requests_.end()) return;
  const Request& request = found->second;
  Message bare = rep;
  bare.tag.clear();
  bare.from.clear();
  // Members of a group come before the answer itself.
  const bool last =
      rep.slot == request.slot || rep.slot == request.slot + ".error" || rep.slot == "Error";
  if (!Publish({.topic = request.response_topic,
                .payload = vm::FormatMessage(bare),
                .correlation = request.correlation},
               {}))
    ++dropped_;
  if (last) requests_.erase(found);
}

void Bridge::OnCommand(const Topic& topic, const Packet& packet) {
  const auto refuse = [&](const std::string& slot, Errc code, const std::string& text) {
    Refuse(packet, slot, Error{code, text, 0});
  };
  Message message;
  if (topic.kind == Kind::kDo) {
    auto parsed = vm::ParseMessage(packet.payload);
    if (!parsed) return Refuse(packet, "Error", parsed.error());
    message = std::move(*parsed);
  } else if (topic.kind == Kind::kSet) {
    message = vm::Set(topic.slot, packet.payload);
  } else if (topic.kind == Kind::kInq) {
    message = vm::Inq(topic.slot);
  } else {
    return refuse("Error", Errc::kSyntax, "this topic is ours to publish");
  }
  const std::string slot = SlotOf(message);
  if (message.command == Command::kRep || message.command == Command::kTell)
    return refuse(
        "Error", Errc::kUnknownCommand,
        "found '" + packet.payload.substr(0, 40) + "', expected a command such as set or inq");
  if (!message.to.empty()) return refuse(slot, Errc::kSyntax, "found 'to', the topic says to whom");
  message.tag.clear();
  message.from.clear();
  message.to = {topic.module};
  if (!vm::IsValid(message))
    return refuse(slot, Errc::kBadValue, "the payload is not one line of UTF-8 text");
  if (!Shows(topic.module) || topic.module == kName)
    return refuse(slot, Errc::kAccess, "@" + topic.module + " is not to be spoken to from here");
  if (topic.module == "AM" && kOfTheConnection.contains(message.slot))
    return refuse(slot, Errc::kAccess, message.slot + " is for clients of the hub itself");
  if (packet.response_topic.empty()) return hub_.Receive(gateway_, std::move(message));
  // We may be allowed to publish where the one who asks is not: answers go to nobody's commands.
  const auto answers_to = ParseTopic(config_.root, packet.response_topic);
  if (packet.response_topic.starts_with(config_.root + "/") &&
      (!answers_to || answers_to->kind != Kind::kReply)) {
    Packet unanswered = packet;
    unanswered.response_topic.clear();
    return Refuse(unanswered, slot,
                  {Errc::kAccess, "answers do not go to '" + packet.response_topic + "'", 0});
  }
  if (packet.correlation.size() > kMaxCorrelationBytes)
    return refuse(slot, Errc::kLimit,
                  "correlation data over " + std::to_string(kMaxCorrelationBytes) + " bytes");
  if (requests_.size() >= kMaxRequests)
    return refuse(slot, Errc::kLimit,
                  "more than " + std::to_string(kMaxRequests) + " requests are unanswered");
  message.tag = "q" + std::to_string(++last_tag_);
  requests_[message.tag] = {packet.response_topic, packet.correlation, slot};
  hub_.Receive(gateway_, std::move(message));
}

}  // namespace am::mqtt
