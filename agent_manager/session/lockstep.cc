#include "agent_manager/session/lockstep.h"

#include <algorithm>
#include <sstream>
#include <utility>

namespace am {

using vm::Result;

Lockstep::Lockstep(boost::asio::io_context& io, vm::ClockScheduler& clock, Hub& hub, OnLost on_lost)
    : clock_(clock), hub_(hub), on_lost_(std::move(on_lost)), patience_(io) {}

void Lockstep::GrantAll(vm::Time time) {
  for (const PeerKey module : hub_.clocks().WithClock()) {
    open_.insert(module);
    hub_.Grant(module, time,
               [this, module](const Result<std::string>& answer) { OnAnswer(module, answer); });
  }
  granted_ = time;
  // Real time: the session's own clock stands until all have answered.
  patience_.expires_after(kPatience);
  patience_.async_wait([this](const auto& error) {
    if (error) return;
    const auto late = open_;
    for (const PeerKey module : late)
      on_lost_(module, "has not answered for " + vm::FormatMs(kPatience) + " ms");
  });
}

void Lockstep::OnAnswer(PeerKey module, const Result<std::string>& answer) {
  open_.erase(module);
  if (open_.empty()) patience_.cancel();
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
  event.stale = event.at && *event.at <= granted_ ? event.stale + 1 : 0;
  if (event.stale <= kMaxStaleEvents) return;
  next_.erase(module);
  on_lost_(module, "names " + next + " as its next event at " + vm::FormatMs(granted_) + " ms");
}

void Lockstep::ForgetGone() {
  const auto there = hub_.clocks().WithClock();
  std::erase_if(next_, [&there](const auto& entry) {
    return std::ranges::find(there, entry.first) == there.end();
  });
}

bool Lockstep::StepNow() {
  if (clock_.Next() && *clock_.Next() <= clock_.Now()) {
    clock_.Advance(clock_.Now());
    return true;
  }
  if (granted_ == clock_.Now() && !hub_.AnyGrantOutdated()) return false;
  GrantAll(clock_.Now());
  return true;
}

bool Lockstep::StepOn() {
  std::optional<vm::Time> next = clock_.Next();
  for (const auto& [module, event] : next_) {
    if (event.at && (!next || *event.at < *next)) next = event.at;
  }
  if (!next) return false;
  clock_.Advance(*next);
  GrantAll(clock_.Now());
  return true;
}

bool Lockstep::Busy() const {
  return std::ranges::any_of(next_, [](const auto& entry) { return entry.second.busy; });
}

}  // namespace am
