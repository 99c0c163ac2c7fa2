#include "agent_manager/supervision/managed_module.h"

#include <utility>

namespace am {

using vm::Errc;
using SteadyClock = std::chrono::steady_clock;

std::string ManagedModule::StateName(State state) {
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

ManagedModule::ManagedModule(boost::asio::io_context& io, Hub& hub, ChildReaper& reaper,
                             const ModuleConfig& config, const Events& events)
    : io_(io),
      hub_(hub),
      reaper_(reaper),
      config_(config),
      events_(events),
      restart_timer_(io),
      hold_timer_(io) {}

ModuleStatus ManagedModule::Status() const {
  return {config_.name, StateName(state_), run_ ? run_->pid() : -1, starts_, ending_, failed_};
}

ModuleRun::Events ManagedModule::RunEvents() {
  // It outlives its runs, but for the last lines of their output.
  return {.on_joined = [this] { OnJoined(); },
          .on_output =
              [self = weak_from_this()](const OutputLine& line) {
                if (const auto module = self.lock()) module->OnOutput(line);
              },
          .on_notice = [this](const std::string& text) { Notice(": " + text); },
          .on_ended = [this](const ModuleRun::Ending& ending) { OnEnded(ending); }};
}

vm::Result<void> ManagedModule::Start(bool watch_health) {
  watch_health_ = watch_health;
  state_ = State::kStarting;
  started_ = SteadyClock::now();
  history_.Started(started_);
  holds_ = true;
  failed_start_ = false;
  ++starts_;
  run_ = std::make_shared<ModuleRun>(io_, hub_, reaper_, config_, RunEvents());
  const auto started = run_->Start();
  if (started) return {};
  run_.reset();
  ending_ = started.error().text;
  failed_ = true;
  events_.on_notice(ending_);
  if (started.error().code == Errc::kBusy) {
    RestartByPolicy(ending_, true, {});
  } else {
    GiveUp(State::kFailed, ending_);  // it will not be there later either
  }
  return started;
}

void ManagedModule::OnJoined() {
  const auto kill = [this](const std::string& why) {
    Notice(": " + why + ", it is ended by force");
    run_->Kill(why);
  };
  monitor_ = std::make_shared<HealthMonitor>(io_, hub_, config_,
                                             HealthMonitor::Events{[this] { OnReady(); }, kill});
  monitor_->Start(watch_health_);
}

void ManagedModule::OnOutput(OutputLine line) {
  const bool plain = line.level == "INFO";
  if (failed_start_ && plain) line.level = "ERROR";
  if (holds_ && plain && held_.size() < ModuleOutput::kMaxOutputLines) return Hold(std::move(line));
  LetGo();
  Tell(line);
}

void ManagedModule::Hold(OutputLine line) {
  if (held_.empty()) {
    hold_timer_.expires_after(kHoldOutput);
    hold_timer_.async_wait([self = weak_from_this()](const auto& error) {
      const auto module = self.lock();
      if (error || !module) return;
      module->holds_ = false;
      module->LetGo();
    });
  }
  held_.push_back(std::move(line));
}

void ManagedModule::LetGo(const std::string& level) {
  hold_timer_.cancel();
  for (OutputLine& line : std::exchange(held_, {})) {
    line.level = level;
    Tell(line);
  }
}

void ManagedModule::Tell(const OutputLine& line) {
  output_.Add(line);
  events_.on_output(config_.name, line);
}

void ManagedModule::OnPresent() {
  if (monitor_) monitor_->OnPresent();
}

void ManagedModule::OnReady() {
  state_ = State::kReady;
  failed_starts_ = 0;
  holds_ = false;
  LetGo();
  for (const Done& done : std::exchange(wait_for_ready_, {})) done(StateName(state_));
  events_.on_ready();
}

void ManagedModule::OnEnded(const ModuleRun::Ending& ending) {
  const bool is_process = run_->is_process();
  run_.reset();
  if (monitor_) std::exchange(monitor_, nullptr)->Stop();
  const bool at_start = state_ == State::kStarting && is_process;
  failed_starts_ = at_start ? failed_starts_ + 1 : 0;
  ending_ = ending.how;
  failed_ = ending.failed;
  failed_start_ =
      at_start && ending.exited_with_error && SteadyClock::now() - started_ < kFirstSeconds;
  spoke_ = spoke_ || ending.spoke || !failed_start_;
  holds_ = false;
  LetGo(failed_start_ ? "ERROR" : "INFO");
  // A program that fails says why in its last line, whether or not that line calls itself an error.
  const std::string reason =
      ending.failed && !ending.last_output.empty() ? ": " + ending.last_output : "";
  if (!reason.empty()) output_.BlameLast(ending.last_output);
  if (is_process && (state_ != State::kStopping || ending.failed)) {
    const std::string what =
        " " + ending.how + (at_start ? " before it was ready" + reason : std::string());
    ending.failed ? Error(what) : Notice(what);
  }
  if (state_ == State::kStopping || !restarts_) return Stopped();
  RestartByPolicy("@" + config_.name + " " + ending.how, ending.failed, reason);
}

void ManagedModule::RestartByPolicy(const std::string& how, bool failed,
                                    const std::string& reason) {
  if (failed_starts_ >= (spoke_ ? kFailedStarts : kMuteStarts)) {
    Error(" has failed to start " + std::to_string(failed_starts_) +
          " times, it is not started again" + reason);
    return GiveUp(State::kFailed, how);
  }
  const auto delay = history_.NextDelay(config_.restart, failed, SteadyClock::now());
  if (!delay && history_.gave_up()) {
    Error(" ended " + std::to_string(history_.recent()) + " times within " +
          vm::FormatMs(config_.restart.within) + " ms, it is not started again" + reason);
    return GiveUp(State::kFailed, how);
  }
  if (!delay) return GiveUp(State::kEnded, how);
  state_ = State::kRestarting;
  restart_timer_.expires_after(*delay);
  restart_timer_.async_wait([self = weak_from_this()](const auto& error) {
    const auto module = self.lock();
    if (!error && module && module->state_ == State::kRestarting)
      static_cast<void>(module->Start(module->watch_health_));
  });
}

void ManagedModule::GiveUp(State state, const std::string& why) {
  state_ = state;
  for (const Done& done : std::exchange(wait_for_ready_, {}))
    done(vm::Fail(Errc::kUnavailable, why));
}

void ManagedModule::AskToStart(Done done) {
  if (state_ == State::kReady) return done(StateName(state_));
  if (state_ == State::kStopping)
    return done(vm::Fail(Errc::kBusy, "@" + config_.name + " is being stopped"));
  wait_for_ready_.push_back(std::move(done));
  if (state_ == State::kStarting || state_ == State::kWaiting) return;
  restart_timer_.cancel();
  history_.Forgive();
  failed_starts_ = 0;
  spoke_ = false;
  state_ = State::kWaiting;
}

void ManagedModule::Stop(Done done) {
  if (done) wait_for_stop_.push_back(std::move(done));
  if (state_ == State::kStopping) return;
  restart_timer_.cancel();
  if (monitor_) monitor_->Stop();
  state_ = State::kStopping;
  run_ ? run_->Stop() : Stopped();
}

void ManagedModule::StopRestarting() {
  restarts_ = false;
  restart_timer_.cancel();
}

bool ManagedModule::Kill(const std::string& why) {
  if (!has_process()) return false;
  run_->Kill(why);
  return true;
}

void ManagedModule::Replace(std::optional<ModuleConfig> config) {
  removed_ = !config;
  replacement_ = std::move(config);
  Stop();
}

bool ManagedModule::TakeReplacement() {
  if (!replacement_) return false;
  config_ = *std::exchange(replacement_, std::nullopt);
  history_.Forgive();
  failed_starts_ = 0;
  spoke_ = false;
  state_ = State::kWaiting;
  return true;
}

void ManagedModule::Stopped() {
  const auto self = shared_from_this();  // those who are told may let go of it
  state_ = State::kStopped;
  for (const Done& done : std::exchange(wait_for_ready_, {}))
    done(vm::Fail(Errc::kStopped, "@" + config_.name + " was stopped"));
  events_.on_stopped(*this);
  for (const Done& done : std::exchange(wait_for_stop_, {})) done(StateName(state_));
}

}  // namespace am
