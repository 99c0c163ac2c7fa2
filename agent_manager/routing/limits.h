#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

#include "vm_protocol/core/limits.h"
#include "vm_protocol/core/scheduler.h"

namespace am {

/// What the hub grants each peer. Every member is a slot Limit.NAME of @AM and a key of "limits" in
/// the configuration; 0 in a rate = no limit. docs/configuration.md says what happens beyond each.
struct Limits {
  std::uint64_t peers = 1024;                          ///< at once, all kinds together
  std::uint64_t messages_per_s = 0;                    ///< from one peer; it is read slower
  std::uint64_t bytes_per_s = 0;                       ///< from one peer; it is read slower
  std::uint64_t backlog_bytes = vm::kMaxBacklogBytes;  ///< unread output of one peer; it is cut
  std::uint64_t stall_ms = 5000;                       ///< a full reader takes nothing; it is cut
  std::uint64_t pending = 8192;                        ///< unanswered requests of one peer
  std::uint64_t waiting = 8192;                        ///< lines held for a module that starts
  std::uint64_t slots = 256;  ///< slots and macros one peer may define, names it subscribes to
  bool operator==(const Limits&) const = default;
};

/// One member of Limits, by its name.
struct LimitName {
  const char* name;
  std::uint64_t Limits::*member;
  std::uint64_t least, most;
  const char* help;
};
const std::vector<LimitName>& LimitNames();

/// A rate with room for one second's worth at once (a token bucket). Pure; the caller says the
/// time.
class RateMeter {
 public:
  /// Counts `amount` against `per_s`; how long the sender has to be held so that the rate is kept,
  /// zero while it is within it. A rate of 0 is none.
  vm::Time Take(double amount, std::uint64_t per_s, vm::Time now);

 private:
  double used_ = 0;  // of one second's worth
  vm::Time at_{0};
};

/// What has passed between a peer and the hub since it came.
struct Traffic {
  std::uint64_t messages_in = 0, bytes_in = 0;
  std::uint64_t messages_out = 0, bytes_out = 0;
  std::uint64_t refused = 0;    ///< lines that were no messages
  std::uint64_t throttled = 0;  ///< times it was held for its rate
  std::uint64_t held = 0;       ///< times it was held for a receiver that did not read
};

}  // namespace am
