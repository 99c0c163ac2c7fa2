#pragma once

#include <string>
#include <vector>

#include "agent_manager/routing/peer.h"
#include "agent_manager/supervision/supervisor.h"

namespace am {

/// The part of the hub's state that is measured; counts are since its start.
struct MetricsSource {
  std::vector<PeerStatus> peers;
  std::vector<ModuleStatus> modules;
  std::uint64_t errors = 0, refused = 0, mqtt_dropped = 0, log_lost_bytes = 0;
  bool mqtt_online = false;
  vm::Time clock{0};
};
/// Formats counters and gauges for Prometheus (text format, version 0.0.4).
std::string FormatMetrics(const MetricsSource& source);

}  // namespace am
