// Who may start, who is ready, who is well.

#include <algorithm>
#include <csignal>

#include "agent_manager/supervision/supervisor.h"
#include "agent_manager/supervision/supervisor_child.h"

namespace am {

namespace {

constexpr std::chrono::milliseconds kAskReadyAgain{200};

}  // namespace

bool Supervisor::MayStart(const Child& child) const {
  return std::ranges::all_of(child.config.after, [this](const std::string& name) {
    const ChildPtr other = Find(name);
    return other != nullptr && other->state == State::kReady;
  });
}

bool Supervisor::IsExpected(const Child& child) const {
  switch (child.state) {
    case State::kWaiting:
      return std::ranges::all_of(child.config.after, [this](const std::string& name) {
        return IsExpected(name) || (Find(name) && Find(name)->state == State::kReady);
      });
    case State::kStarting:
    case State::kReady:
      return child.pid > 0;
    case State::kRestarting:
      return true;
    default:
      return false;
  }
}

bool Supervisor::IsExpected(const std::string& name) const {
  const ChildPtr child = Find(name);
  return child != nullptr && IsExpected(*child);
}

bool Supervisor::AllReady() const {
  return std::ranges::none_of(children_, [this](const ChildPtr& child) {
    return child->state != State::kReady && IsExpected(*child);
  });
}

void Supervisor::AwaitReady(const ChildPtr& child) {
  child->ready_timer.expires_after(child->config.ready_within);
  child->ready_timer.async_wait([this, child](const auto& error) {
    if (!error && child->state == State::kStarting)
      KillChild(child, "not ready within " + vm::FormatMs(child->config.ready_within) + " ms");
  });
  if (hub_.IsReady(child->config.name)) AskReady(child);
}

void Supervisor::OnPresent(const std::string& name) {
  const ChildPtr child = Find(name);
  if (child != nullptr && child->peer != 0 && child->state == State::kStarting) AskReady(child);
}

void Supervisor::AskReady(const ChildPtr& child) {
  if (child->config.ready_slot.empty()) return BecomeReady(child);
  hub_.Ask("AM", vm::To(child->config.name, vm::Inq(child->config.ready_slot)),
           [this, child, peer = child->peer](const vm::Result<std::string>& value) {
             if (child->peer != peer || child->state != State::kStarting) return;
             if (value && *value == child->config.ready_value) return BecomeReady(child);
             child->health_timer.expires_after(kAskReadyAgain);
             child->health_timer.async_wait([this, child, peer](const auto& error) {
               if (!error && child->peer == peer && child->state == State::kStarting)
                 AskReady(child);
             });
           });
}

void Supervisor::BecomeReady(const ChildPtr& child) {
  child->state = State::kReady;
  child->failed_starts = 0;
  child->ready_timer.cancel();
  for (const Done& done : std::exchange(child->on_ready, {})) done(StateName(child->state));
  WatchHealth(child);
  StartWhatCan();
}

void Supervisor::WatchHealth(const ChildPtr& child) {
  const HealthCheck& check = child->config.health;
  if (!watch_health_ || check.every.count() == 0 || child->state != State::kReady) return;
  child->health_timer.expires_after(check.every);
  child->health_timer.async_wait([this, child, peer = child->peer](const auto& error) {
    if (!error && child->peer == peer && child->state == State::kReady) AskHealth(child);
  });
}

void Supervisor::AskHealth(const ChildPtr& child) {
  const auto answered = std::make_shared<bool>(false);
  hub_.Ask("AM", vm::To(child->config.name, vm::Inq("Run")),
           [child, answered, peer = child->peer](const vm::Result<std::string>&) {
             // A refusal is an answer too: somebody is there.
             *answered = true;
             if (child->peer == peer) child->health_misses = 0;
           });
  const HealthCheck& check = child->config.health;
  child->health_timer.expires_after(check.within);
  child->health_timer.async_wait([this, child, answered, peer = child->peer](const auto& error) {
    if (error || child->peer != peer || child->state != State::kReady) return;
    if (!*answered && ++child->health_misses >= child->config.health.misses)
      return KillChild(child, "did not answer inq Run " + std::to_string(child->health_misses) +
                                  " times in a row");
    WatchHealth(child);
  });
}

void Supervisor::KillChild(const ChildPtr& child, const std::string& why) {
  on_notice_("@" + child->config.name + ": " + why + ", it is ended by force");
  child->killed_for = why;
  if (child->pid > 0) {
    child->Signal(SIGKILL);
    return;
  }
  if (child->stream) child->stream->Close();
  LeaveHub(child, why, [this, child, why] { Ended(child, why, true); });
}

bool Supervisor::Kill(const std::string& name, const std::string& why) {
  const ChildPtr child = Find(name);
  if (child == nullptr || child->pid <= 0) return false;
  child->killed_for = why;
  child->Signal(SIGKILL);
  return true;
}

}  // namespace am
