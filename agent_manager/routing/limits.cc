#include "agent_manager/routing/limits.h"

#include <algorithm>

namespace am {

const std::vector<LimitName>& LimitNames() {
  static const std::vector<LimitName> names{
      {"peers", &Limits::peers, 1, 100000, "Peers at once; a further one is closed at once."},
      {"messages_per_s", &Limits::messages_per_s, 0, 1000000000,
       "Messages a peer may send in a second; beyond, it is read slower. 0: no limit."},
      {"bytes_per_s", &Limits::bytes_per_s, 0, 1000000000000,
       "Bytes a peer may send in a second; beyond, it is read slower. 0: no limit."},
      {"backlog_bytes", &Limits::backlog_bytes, 65536, vm::kMaxBacklogBytes,
       "Output a peer has not read. From half of it those who send to it are held; beyond it the "
       "peer is cut off."},
      {"stall_ms", &Limits::stall_ms, 100, 3600000,
       "How long a peer may hold others by not reading, in ms, before it is cut off."},
      {"pending", &Limits::pending, 1, 1000000,
       "Unanswered requests of one peer: from half of it the peer is not read; beyond, its oldest "
       "is answered LIMIT."},
      {"waiting", &Limits::waiting, 1, 1000000,
       "Lines held for a module that is starting; beyond, they are answered LIMIT."},
      {"slots", &Limits::slots, 0, 1000000,
       "Slots and macros a peer may define at the hub; beyond, LIMIT."},
  };
  return names;
}

vm::Time RateMeter::Take(double amount, std::uint64_t per_s, vm::Time now) {
  if (per_s == 0) return vm::Time(0);
  const double elapsed_s = std::chrono::duration<double>(now - at_).count();
  at_ = now;
  used_ = std::max(0.0, used_ - elapsed_s) + amount / static_cast<double>(per_s);
  if (used_ <= 1.0) return vm::Time(0);
  return std::chrono::duration_cast<vm::Time>(std::chrono::duration<double>(used_ - 1.0));
}

}  // namespace am
