#include "agent_manager/slots/metrics.h"

namespace am {

std::string FormatMetrics(const MetricsSource& source) {
  std::string text;
  const auto family = [&text](const std::string& name, const std::string& type,
                              const std::string& help) {
    text += "# HELP galatea_" + name + " " + help + "\n# TYPE galatea_" + name + " " + type + "\n";
  };
  const auto sample = [&text](const std::string& name, const std::string& label, auto value) {
    text += "galatea_" + name + (label.empty() ? "" : "{" + label + "}") + " " +
            std::to_string(value) + "\n";
  };
  const auto of_peers = [&](const std::string& name, const std::string& type,
                            const std::string& help, auto value) {
    family(name, type, help);
    // Names are letters, digits, '_', '-' and UTF-8: nothing that needs an escape.
    for (const PeerStatus& peer : source.peers)
      sample(name, "peer=\"" + peer.name + "\"", value(peer));
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
  family("module_ready", "gauge", "1 while a configured module is ready.");
  for (const ModuleStatus& module : source.modules)
    sample("module_ready", "module=\"" + module.name + "\"", module.state == "READY" ? 1 : 0);
  family("module_starts_total", "counter", "How often a configured module was started.");
  for (const ModuleStatus& module : source.modules)
    sample("module_starts_total", "module=\"" + module.name + "\"", module.starts);
  family("errors_total", "counter", "Errors the hub has reported.");
  sample("errors_total", "", source.errors);
  family("refused_total", "counter", "Connections and requests that were turned away.");
  sample("refused_total", "", source.refused);
  family("mqtt_online", "gauge", "1 while the broker is reached.");
  sample("mqtt_online", "", source.mqtt_online ? 1 : 0);
  family("mqtt_dropped_total", "counter", "What the broker did not take in time.");
  sample("mqtt_dropped_total", "", source.mqtt_dropped);
  family("log_lost_bytes_total", "counter", "Bytes of the session log that could not be written.");
  sample("log_lost_bytes_total", "", source.log_lost_bytes);
  family("clock_seconds", "gauge", "The session's clock.");
  sample("clock_seconds", "", static_cast<double>(source.clock.count()) / 1e6);
  return text;
}

}  // namespace am
