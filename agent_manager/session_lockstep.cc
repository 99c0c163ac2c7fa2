// The virtual clock: all modules in lockstep (docs/architecture.md "Time").

#include <iostream>
#include <sstream>

#include "agent_manager/session.h"

namespace am {

using std::chrono::milliseconds;
using vm::Result;

namespace {

constexpr milliseconds kGrantPatience{60000};  // for a module to do what is due

}  // namespace

void Session::GrantAll(vm::Time time) {
  for (const PeerKey module : hub_.ModernModules()) {
    open_grants_.insert(module);
    hub_.AskClock(module, time, [this, module](const Result<std::string>& answer) {
      OnClockAnswer(module, answer);
    });
  }
  granted_ = time;
  // Real time: the session's own clock stands until all have answered.
  grant_timer_.expires_after(kGrantPatience);
  grant_timer_.async_wait([this](const auto& error) {
    if (error) return;
    const auto late = open_grants_;
    for (const PeerKey module : late) {
      const std::string name = hub_.NameOf(module);
      ++errors_;
      std::cerr << "agent_manager: @" << name << " has not followed the clock for "
                << kGrantPatience.count() << " ms, it is ended" << std::endl;
      if (!supervisor_.Kill(name, "has not followed the clock"))
        hub_.Detach(module, "does not follow the clock");
    }
  });
}

void Session::OnClockAnswer(PeerKey module, const Result<std::string>& answer) {
  open_grants_.erase(module);
  if (open_grants_.empty()) grant_timer_.cancel();
  if (!answer) {
    next_.erase(module);
    return;
  }
  std::istringstream words(*answer);  // NOW NEXT [BUSY]
  std::string now, next, busy;
  words >> now >> next >> busy;
  NextEvent& event = next_[module];
  event.at.reset();
  if (const auto at = vm::ParseMs(next)) event.at = *at;
  event.busy = busy == "BUSY";
}

void Session::StepVirtual() {
  // Only when nothing is on its way: all grants answered, nothing due here, nobody newly spoken to.
  if (!open_grants_.empty() || !Started()) {
    io_.run_one();
    return;
  }
  if (io_.poll() > 0) return;
  if (clock_.Next() && *clock_.Next() <= clock_.Now()) {
    clock_.Advance(clock_.Now());
    return;
  }
  if (granted_ != clock_.Now() || !hub_.dirty().empty()) return GrantAll(clock_.Now());
  CheckIdleWait();
  if (!hub_.dirty().empty() || (clock_.Next() && *clock_.Next() <= clock_.Now())) return;
  const bool time_wanted = SomethingGoesOn() || timed_wait_ || idle_wait_;
  std::optional<vm::Time> next = clock_.Next();
  for (const auto& [module, event] : next_) {
    if (event.at && (!next || *event.at < *next)) next = event.at;
  }
  if (time_wanted && next) {
    clock_.Advance(*next);
    return GrantAll(clock_.Now());
  }
  if (!Over()) io_.run_one();
}

}  // namespace am
