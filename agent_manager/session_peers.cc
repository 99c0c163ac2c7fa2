// The slots of @AM about its peers: what they may do and what they have done.

#include "agent_manager/mqtt/bridge.h"
#include "agent_manager/session.h"

namespace am {

using vm::Result;
using vm::SetValue;

namespace {

std::string_view KindName(PeerKind kind) {
  switch (kind) {
    case PeerKind::kConsole:
      return "CONSOLE";
    case PeerKind::kModule:
      return "MODULE";
    case PeerKind::kRemote:
      return "REMOTE";
    case PeerKind::kClient:
      break;
  }
  return "CLIENT";
}

}  // namespace

void Session::DeclareLimitSlots() {
  for (const LimitName& limit : LimitNames()) {
    slots_.Declare(
        {.name = std::string("Limit.") + limit.name,
         .grammar = "<int " + std::to_string(limit.least) + ".." + std::to_string(limit.most) + ">",
         .initial = std::to_string(Limits().*limit.member),
         .help = limit.help,
         .on_set = [this, member = limit.member](const SetValue& value) -> Result<std::string> {
           hub_.limits().*member = static_cast<std::uint64_t>(value.number(0));
           return value.word(0);
         },
         .on_inq = [this,
                    member = limit.member] { return std::to_string(hub_.limits().*member); }});
  }
  slots_.Declare({.name = "Flow",
                  .grammar = "ON | OFF",
                  .access = vm::Access::kWriteOnly,
                  .help = "ON: you are shown every message, as a comment: # flow TIME_MS SENDER "
                          "RECEIVERS LINE, with tabs between.",
                  .on_set = [this](const SetValue& value) -> Result<std::string> {
                    if (value.word(0) == "ON") {
                      onlookers_.insert(value.peer);
                    } else {
                      onlookers_.erase(value.peer);
                    }
                    log_.set_enabled(log_writer_ != nullptr || !onlookers_.empty());
                    return value.word(0);
                  }});
  slots_.Declare({.name = "Refused",
                  .grammar = "<text>",
                  .access = vm::Access::kReadOnly,
                  .initial = "0",
                  .help = "How many were turned away at a door so far, and who the last one was."});
  slots_.Declare({.name = "Mqtt",
                  .grammar = "<text>",
                  .access = vm::Access::kReadOnly,
                  .initial = "NONE",
                  .help =
                      "The broker by which other agents are reached: ONLINE and where, AWAY and "
                      "why, or NONE."});
  slots_.Declare({.name = "Traffic",
                  .grammar = "<text>",
                  .access = vm::Access::kReadOnly,
                  .help = "Of each peer: NAME KIND and, since it came, in=MESSAGES/BYTES, "
                          "out=MESSAGES/BYTES, backlog=BYTES not yet read, pending=REQUESTS it has "
                          "not answered, slots=it has defined, refused=LINES that were none, "
                          "throttled= and held=TIMES it was read slower; HELD if it is now.",
                  .on_inq = [this] {
                    std::string text;
                    const auto number = [](auto n) { return std::to_string(n); };
                    for (const PeerStatus& peer : hub_.Status()) {
                      const Traffic& t = peer.traffic;
                      text += (text.empty() ? "" : ", ") + peer.name + " " +
                              std::string(KindName(peer.kind)) + " in=" + number(t.messages_in) +
                              "/" + number(t.bytes_in) + " out=" + number(t.messages_out) + "/" +
                              number(t.bytes_out) + " backlog=" + number(peer.backlog_bytes) +
                              " pending=" + number(peer.pending) +
                              " slots=" + number(peer.defined) + " refused=" + number(t.refused) +
                              " throttled=" + number(t.throttled) + " held=" + number(t.held) +
                              (peer.held ? " HELD" : "");
                    }
                    return text;
                  }});
}

std::string Session::Metrics() const {
  std::string text;
  const auto family = [&text](const std::string& name, const std::string& type,
                              const std::string& help) {
    text += "# HELP galatea_" + name + " " + help + "\n# TYPE galatea_" + name + " " + type + "\n";
  };
  const auto sample = [&text](const std::string& name, const std::string& label, auto value) {
    text += "galatea_" + name + (label.empty() ? "" : "{" + label + "}") + " " +
            std::to_string(value) + "\n";
  };
  const auto peers = hub_.Status();
  const auto of_peers = [&](const std::string& name, const std::string& type,
                            const std::string& help, auto value) {
    family(name, type, help);
    // Names are letters, digits, '_', '-' and UTF-8: nothing that needs an escape.
    for (const PeerStatus& peer : peers) sample(name, "peer=\"" + peer.name + "\"", value(peer));
  };
  of_peers("messages_in_total", "counter", "Messages from a peer.",
           [](const PeerStatus& peer) { return peer.traffic.messages_in; });
  of_peers("messages_out_total", "counter", "Messages to a peer.",
           [](const PeerStatus& peer) { return peer.traffic.messages_out; });
  of_peers("bytes_in_total", "counter", "Bytes from a peer.",
           [](const PeerStatus& peer) { return peer.traffic.bytes_in; });
  of_peers("bytes_out_total", "counter", "Bytes to a peer.",
           [](const PeerStatus& peer) { return peer.traffic.bytes_out; });
  of_peers("refused_lines_total", "counter", "Lines of a peer that were no messages.",
           [](const PeerStatus& peer) { return peer.traffic.refused; });
  of_peers("held_total", "counter", "Times a peer was read slower.",
           [](const PeerStatus& peer) { return peer.traffic.held + peer.traffic.throttled; });
  of_peers("backlog_bytes", "gauge", "Output a peer has not read.",
           [](const PeerStatus& peer) { return peer.backlog_bytes; });
  of_peers("pending_requests", "gauge", "Requests a peer has not answered.",
           [](const PeerStatus& peer) { return peer.pending; });
  const auto modules = supervisor_.Status();
  family("module_ready", "gauge", "1 while a configured module is ready.");
  for (const ModuleStatus& module : modules)
    sample("module_ready", "module=\"" + module.name + "\"", module.state == "READY" ? 1 : 0);
  family("module_starts_total", "counter", "How often a configured module was started.");
  for (const ModuleStatus& module : modules)
    sample("module_starts_total", "module=\"" + module.name + "\"", module.starts);
  family("errors_total", "counter", "Errors the hub has reported.");
  sample("errors_total", "", errors_);
  family("refused_total", "counter", "Those turned away at a door.");
  sample("refused_total", "", refused_);
  family("mqtt_online", "gauge", "1 while the broker is reached.");
  sample("mqtt_online", "", mqtt_ != nullptr && mqtt_->online() ? 1 : 0);
  family("mqtt_dropped_total", "counter", "What the broker did not take in time.");
  sample("mqtt_dropped_total", "", mqtt_ != nullptr ? mqtt_->dropped() : 0);
  family("log_lost_bytes_total", "counter", "Bytes of the session log that could not be written.");
  sample("log_lost_bytes_total", "", log_writer_ ? log_writer_->lost() : 0);
  family("clock_seconds", "gauge", "The session's clock.");
  sample("clock_seconds", "", static_cast<double>(clock_.Now().count()) / 1e6);
  return text;
}

}  // namespace am
