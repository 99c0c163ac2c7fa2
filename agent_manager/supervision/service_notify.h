#pragma once

#include <chrono>
#include <optional>
#include <string>

namespace am {

/// Tells the service manager what it may want to know (sd_notify(3)): "READY=1", "STOPPING=1",
/// "RELOADING=1", "WATCHDOG=1". Does nothing where NOTIFY_SOCKET is not set.
void NotifyService(const std::string& state);

/// How often the service manager wants to hear WATCHDOG=1 at least; none = it does not.
std::optional<std::chrono::microseconds> WatchdogPeriod();

}  // namespace am
