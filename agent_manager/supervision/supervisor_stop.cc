// Orderly ends, starts by hand, and changes of the configuration.

#include <algorithm>
#include <csignal>

#include "agent_manager/supervision/supervisor.h"
#include "agent_manager/supervision/supervisor_child.h"

namespace am {

using vm::Errc;

namespace {

constexpr std::chrono::milliseconds kTerminatePatience{1000};  // after SIGTERM

vm::Error NoSuchModule(const std::string& name) {
  return {Errc::kUnknownModule, "@" + name + " is not configured", 0};
}

}  // namespace

std::string Supervisor::StateName(State state) {
  switch (state) {
    case State::kWaiting:
      return "WAITING";
    case State::kStarting:
      return "STARTING";
    case State::kReady:
      return "READY";
    case State::kRestarting:
      return "RESTARTING";
    case State::kStopping:
      return "STOPPING";
    case State::kStopped:
      return "STOPPED";
    case State::kEnded:
      return "ENDED";
    case State::kFailed:
      return "FAILED";
  }
  return "";
}

std::vector<ModuleStatus> Supervisor::Status() const {
  std::vector<ModuleStatus> all;
  for (const auto& child : children_)
    all.push_back(
        {child->config.name, StateName(child->state), child->pid, child->starts, child->ending});
  return all;
}

std::deque<OutputLine> Supervisor::Output(const std::string& name) const {
  const ChildPtr child = Find(name);
  return child == nullptr ? std::deque<OutputLine>{} : child->output;
}

void Supervisor::Apply(const std::vector<ModuleConfig>& modules) {
  const auto before = children_;
  for (const auto& child : before) {
    const auto wanted = std::ranges::find(modules, child->config.name, &ModuleConfig::name);
    if (child->removed || (wanted != modules.end() && *wanted == child->config)) continue;
    if (wanted == modules.end()) {
      child->removed = true;
    } else {
      child->successor = *wanted;
    }
    AskToStop(child);
  }
  for (const ModuleConfig& module : modules) {
    if (Find(module.name) == nullptr) children_.push_back(std::make_shared<Child>(io_, module));
  }
  StartWhatCan();
  first_apply_ = false;
}

void Supervisor::StartOne(const std::string& name, Done done) {
  const ChildPtr child = Find(name);
  if (child == nullptr) return done(std::unexpected(NoSuchModule(name)));
  if (child->state == State::kReady) return done(StateName(child->state));
  if (child->state == State::kStopping || stopping_)
    return done(vm::Fail(Errc::kBusy, "@" + name + " is being stopped"));
  child->on_ready.push_back(std::move(done));
  if (child->state == State::kStarting || child->state == State::kWaiting) return;
  child->restart_timer.cancel();
  child->history.Forgive();
  child->failed_starts = 0;
  child->state = State::kWaiting;
  StartWhatCan();
}

void Supervisor::StopOne(const std::string& name, Done done) {
  const ChildPtr child = Find(name);
  if (child == nullptr) return done(std::unexpected(NoSuchModule(name)));
  child->on_stopped.push_back(std::move(done));
  if (child->state != State::kStopping) AskToStop(child);
}

void Supervisor::RestartOne(const std::string& name, Done done) {
  StopOne(name, [this, name, done](const vm::Result<std::string>& stopped) {
    if (!stopped) return done(stopped);
    StartOne(name, done);
  });
}

void Supervisor::AskToStop(const ChildPtr& child) {
  child->restart_timer.cancel();
  child->ready_timer.cancel();
  child->health_timer.cancel();
  const bool running = child->running();
  child->state = State::kStopping;
  if (!running) return Stopped(child);
  if (child->pid <= 0) {  // connected to: only the connection ends
    child->stream->Close();
    return LeaveHub(child, "the hub lets it go", [this, child] { Stopped(child); });
  }
  // The first waits until what was said before is done, the second does not.
  for (int i = 0; i < 2 && child->stream; ++i) child->stream->Send("set Run = EXIT");
  child->stop_timer.expires_after(child->config.stop_within);
  child->stop_timer.async_wait([child](const auto& error) {
    if (error || child->pid <= 0) return;
    child->killed_for = "did not exit within " + vm::FormatMs(child->config.stop_within) + " ms";
    child->Signal(SIGTERM);
    child->stop_timer.expires_after(kTerminatePatience);
    child->stop_timer.async_wait([child](const auto& late) {
      if (!late) child->Signal(SIGKILL);
    });
  });
}

void Supervisor::Stopped(const ChildPtr& child) {
  child->state = State::kStopped;
  for (const Done& done : std::exchange(child->on_ready, {}))
    done(vm::Fail(Errc::kStopped, "@" + child->config.name + " was stopped"));
  if (child->removed) std::erase(children_, child);
  if (child->successor && !stopping_) {
    child->config = *std::exchange(child->successor, std::nullopt);
    child->history.Forgive();
    child->state = State::kWaiting;
    StartWhatCan();
  }
  for (const Done& done : std::exchange(child->on_stopped, {})) done(StateName(child->state));
  if (stopping_) StopNext();
}

void Supervisor::StopAll(std::function<void()> done) {
  if (stopping_) return;
  stopping_ = true;
  on_stopped_ = std::move(done);
  for (const auto& child : children_) child->restart_timer.cancel();
  StopNext();
}

void Supervisor::StopNext() {
  // One at a time: the last one that no other running module comes after.
  const auto needed = [this](const Child& child) {
    return std::ranges::any_of(children_, [&](const ChildPtr& other) {
      return other->running() &&
             std::ranges::find(other->config.after, child.config.name) != other->config.after.end();
    });
  };
  for (const auto& child : children_) {
    if (child->running() && child->state == State::kStopping) return;  // its end comes back here
  }
  for (auto it = children_.rbegin(); it != children_.rend(); ++it) {
    if ((*it)->running() && !needed(**it)) return AskToStop(*it);
  }
  if (auto done = std::exchange(on_stopped_, nullptr)) done();
}

}  // namespace am
