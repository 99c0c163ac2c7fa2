#include "agent_manager/mqtt/local_gateway.h"

#include <algorithm>
#include <memory>
#include <stdexcept>
#include <utility>

#include "agent_manager/access/pattern.h"
#include "agent_manager/routing/own_names.h"
#include "agent_manager/routing/tag.h"
#include "vm_protocol/core/utf8.h"

namespace am::mqtt {

using vm::Command;
using vm::Errc;
using vm::Fail;
using vm::Message;
using vm::Result;
using Kind = Topic::Kind;

namespace {

constexpr char kTagLetter = 'q';
const std::set<std::string> kInside{own_name::kHub, own_name::kMacros,
                                    own_name::kMacrosOfTheOriginal};
/// Slots of @AM about the connection they are said on, which here is everybody's.
const std::set<std::string> kOfTheConnection{"Name", "Subscribe", "Flow", "Wait"};

}  // namespace

/// What @MQTT hears.
class LocalGateway::GatewayLink final : public Link {
 public:
  explicit GatewayLink(LocalGateway& gateway) : gateway_(gateway) {}
  void Send(const Outgoing& outgoing) override { gateway_.OnOurMessage(outgoing.message()); }
  void Close() override {}

 private:
  LocalGateway& gateway_;
};

LocalGateway::LocalGateway(Hub& hub, const MqttConfig& config, Broker& broker, Publisher& publisher,
                           OnNotice on_notice)
    : hub_(hub),
      config_(config),
      topics_{config.root, config.agent},
      broker_(broker),
      publisher_(publisher),
      on_notice_(std::move(on_notice)) {
  const auto peer = hub_.Attach(std::make_unique<GatewayLink>(*this), PeerKind::kClient,
                                config_.role, kName, Dialect::kAuto);
  if (!peer) throw std::runtime_error("mqtt: " + peer.error().text);
  peer_ = *peer;
  hub_.Subscribe(peer_, {"*"});
}

LocalGateway::~LocalGateway() { hub_.Evict(peer_, "the bridge to the broker has ended"); }

bool LocalGateway::Shows(const std::string& module) const {
  return config_.modules.empty() ||
         std::ranges::any_of(config_.modules, [&](const std::string& pattern) {
           return MatchesPattern(pattern, module);
         });
}

void LocalGateway::ShowModules() {
  for (const PeerStatus& peer : hub_.Status()) {
    if (peer.kind == PeerKind::kModule && hub_.directory().IsReady(peer.name))
      live_.insert(peer.name);
  }
  PublishModules();
}

void LocalGateway::OnPresence(const std::string& name, bool present, const std::string& reason) {
  if (name.find('/') != std::string::npos) return;
  if (present ? !live_.insert(name).second : live_.erase(name) == 0) return;
  if (!Shows(name)) return;
  // What it has reported was true of the one that is gone.
  const std::string state = topics_.Path(Kind::kModuleState, name);
  if (!present) publisher_.ForgetValues(topics_.Path(Kind::kSlot, name, ""), state);
  publisher_.SetValue(state, present ? "LIVE" : "GONE " + reason);
  PublishModules();
}

void LocalGateway::PublishModules() {
  std::string names;
  for (const auto& group : {kInside, live_}) {
    for (const std::string& name : group) {
      if (Shows(name)) names += (names.empty() ? "" : " ") + name;
    }
  }
  publisher_.SetValue(topics_.Path(Kind::kModules), names);
}

void LocalGateway::OnOurMessage(const Message& said) {
  if (said.command != Command::kRep && said.command != Command::kTell) {
    if (said.tag.empty()) return;
    Message rep = vm::Rep(SlotOf(said) + ".error",
                          "UNKNOWN_SLOT the broker has no slots of its own: to @AGENT/MODULE "
                          "reaches others");
    rep.tag = said.tag;
    return hub_.Receive(peer_, std::move(rep));
  }
  if (!said.tag.empty()) return Answer(said);
  const std::string& from = said.from;
  if ((!kInside.contains(from) && !hub_.directory().IsModule(from)) || !Shows(from)) return;
  const bool error = said.slot == "Error" || said.slot.ends_with(".error");
  if (said.command == Command::kRep && !error)
    return publisher_.SetValue(
        topics_.Path(Kind::kSlot, from, said.slot), said.value,
        hub_.directory().IsGuest(from) ? Publisher::Whose::kGuests : Publisher::Whose::kOurs);
  Message bare = said;
  bare.from.clear();
  publisher_.PublishEvent({.topic = topics_.Path(error ? Kind::kError : Kind::kTell, from),
                           .payload = error ? vm::FormatMessage(bare) : said.value});
}

void LocalGateway::Answer(const Message& rep) {
  const auto found = requests_.find(NumberOfTag(kTagLetter, rep.tag));
  if (found == requests_.end()) return;
  Request& request = found->second;
  Message bare = rep;
  bare.tag.clear();
  bare.from.clear();
  // Members of a group come before the answer itself. Where a rule has renamed the slot the answer
  // looks like a member; such requests go when there are too many.
  const bool last = rep.slot == request.slot || rep.slot.ends_with(".error") || rep.slot == "Error";
  request.answered = true;
  publisher_.PublishAnswer({.topic = request.response_topic,
                            .payload = vm::FormatMessage(bare),
                            .correlation = request.correlation});
  if (last) requests_.erase(found);
}

void LocalGateway::SubscribeToCommands() {
  // Commands that stand there retained would be carried out at every connection.
  for (const char* filter : {"/$do/+", "/+/+/set", "/+/+/inq"})
    broker_.Subscribe(config_.root + "/" + config_.agent + filter, false);
}

void LocalGateway::OnCommand(const Topic& topic, const Packet& packet) {
  auto command = CommandOf(topic, packet);
  if (!command) return Refuse(packet, "Error", command.error());
  Message message = std::move(*command);
  const std::string slot = SlotOf(message);
  if (!message.to.empty())
    return Refuse(packet, slot, {Errc::kSyntax, "found 'to', the topic says to whom", 0});
  message.tag.clear();
  message.from.clear();
  message.to = {topic.module};
  if (const auto checked = CheckCommand(topic.module, message); !checked)
    return Refuse(packet, slot, checked.error());
  if (packet.response_topic.empty()) return hub_.Receive(peer_, std::move(message));
  Ask(packet, slot, std::move(message));
}

Result<Message> LocalGateway::CommandOf(const Topic& topic, const Packet& packet) const {
  if (topic.kind == Kind::kSet) return vm::Set(topic.slot, packet.payload);
  if (topic.kind == Kind::kInq) return vm::Inq(topic.slot);
  if (topic.kind != Kind::kDo) return Fail(Errc::kSyntax, "this topic is ours to publish");
  auto message = vm::ParseMessage(packet.payload);
  if (message && (message->command == Command::kRep || message->command == Command::kTell))
    return Fail(Errc::kUnknownCommand, "found '" + std::string(vm::CutUtf8(packet.payload, 40)) +
                                           "', expected a command such as set or inq");
  return message;
}

Result<void> LocalGateway::CheckCommand(const std::string& module, const Message& message) const {
  if (!vm::IsValid(message))
    return Fail(Errc::kBadValue, "the payload is not one line of UTF-8 text");
  if (!Shows(module) || module == kName)
    return Fail(Errc::kAccess, "@" + module + " is not to be spoken to from here");
  if (module == own_name::kHub && kOfTheConnection.contains(message.slot))
    return Fail(Errc::kAccess, message.slot + " is for clients of the hub itself");
  return {};
}

void LocalGateway::Ask(const Packet& packet, const std::string& slot, Message message) {
  const auto refuse = [&](Errc code, const std::string& text) {
    Refuse(packet, slot, {code, text, 0});
  };
  if (!MayAnswerTo(packet.response_topic))
    return refuse(Errc::kAccess, "answers do not go to '" +
                                     std::string(vm::CutUtf8(packet.response_topic, 200)) + "'");
  if (packet.response_topic.size() > kMaxResponseTopicBytes)
    return refuse(Errc::kLimit,
                  "response topic over " + std::to_string(kMaxResponseTopicBytes) + " bytes");
  if (packet.correlation.size() > kMaxCorrelationBytes)
    return refuse(Errc::kLimit,
                  "correlation data over " + std::to_string(kMaxCorrelationBytes) + " bytes");
  if (requests_.size() >= kMaxRequests) ForgetOldest();
  message.tag = FormatTag(kTagLetter, ++last_number_);
  requests_[last_number_] = {packet.response_topic, packet.correlation, slot};
  hub_.Receive(peer_, std::move(message));
}

void LocalGateway::ForgetOldest() {
  const Request oldest = std::move(requests_.extract(requests_.begin()).mapped());
  if (oldest.answered) return;
  const vm::Error error{
      Errc::kLimit, "more than " + std::to_string(kMaxRequests) + " requests are unanswered", 0};
  PublishRefusal(oldest, error);
}

/// We may be allowed to publish where the one who asks is not: below the root, answers and refusals
/// go to an agent's $reply only, never to a topic that is a command or a value.
bool LocalGateway::MayAnswerTo(const std::string& topic) const {
  if (!topic.starts_with(config_.root + "/")) return true;
  const auto parsed = ParseTopic(config_.root, topic);
  return parsed && parsed->kind == Kind::kReply;
}

void LocalGateway::Refuse(const Packet& packet, const std::string& slot, const vm::Error& error) {
  const std::string text = vm::FormatError(error);
  on_notice_("refused '" + std::string(vm::CutUtf8(packet.topic, 200)) + "': " + text);
  if (packet.response_topic.empty() || !MayAnswerTo(packet.response_topic)) return;
  PublishRefusal({packet.response_topic, packet.correlation, slot}, error);
}

void LocalGateway::PublishRefusal(const Request& request, const vm::Error& error) {
  publisher_.PublishAnswer({.topic = request.response_topic,
                            .payload = "rep " + request.slot +
                                       (request.slot == "Error" ? "" : ".error") + " = " +
                                       vm::FormatError(error),
                            .correlation = request.correlation});
}

}  // namespace am::mqtt
