#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "agent_manager/config/config.h"
#include "agent_manager/supervision/health_monitor.h"
#include "agent_manager/supervision/module_output.h"
#include "agent_manager/supervision/module_run.h"
#include "agent_manager/supervision/restart_history.h"

namespace am {

/// What there is to know about one configured module.
struct ModuleStatus {
  std::string name;
  std::string state;    ///< ManagedModule::StateName
  pid_t pid = -1;       ///< -1: no process
  unsigned starts = 0;  ///< in all
  std::string ending;   ///< how it ended the last time; empty = it never did
  bool failed = false;  ///< that was a failure
};

/// One module of the configuration over all its runs: its state, its restarts by policy, and those
/// who wait for it to become ready or to stop. A module whose program ends before it is ready
/// kFailedStarts times in a row, or cannot be run at all, is not started again by itself; one that
/// ends with an error within kFirstSeconds each time and never said a line has kMuteStarts. What
/// such a start wrote to stderr without a level is an ERROR; to tell, it is held back until it is
/// ready or kHoldOutput have passed. Thread: the context's. All that it is given outlives it.
class ManagedModule : public std::enable_shared_from_this<ManagedModule> {
 public:
  enum class State {
    kWaiting,     ///< for the modules that it comes after
    kStarting,    ///< it runs and is not ready yet
    kReady,       ///< its `ready` condition holds
    kRestarting,  ///< it waits for its next start
    kStopping,    ///< it was asked to exit
    kStopped,     ///< by hand
    kEnded,       ///< by itself, and its restart policy leaves it at that
    kFailed,      ///< it cannot be started, or ended too often
  };
  /// "WAITING", "STARTING", ...
  static std::string StateName(State state);
  static constexpr unsigned kFailedStarts = 3, kMuteStarts = 2;
  static constexpr std::chrono::milliseconds kFirstSeconds{5000}, kHoldOutput{2000};
  using Done = std::function<void(vm::Result<std::string> state)>;
  struct Events {
    std::function<void(const std::string& text)> on_notice;  ///< for people
    std::function<void(const std::string& module, const OutputLine& line)> on_output;
    std::function<void()> on_ready;
    /// It has stopped as it was asked to, and those who asked have not been told yet.
    std::function<void(ManagedModule& module)> on_stopped;
  };
  ManagedModule(boost::asio::io_context& io, Hub& hub, ChildReaper& reaper,
                const ModuleConfig& config, const Events& events);
  ManagedModule(const ManagedModule&) = delete;

  /// Starts a run. On an error a person has been told and the state says what follows.
  /// REQUIRES: state kWaiting or kRestarting.
  vm::Result<void> Start(bool watch_health);
  /// Forgets past failures and waits for its turn to start; `done` once it is ready, or has failed.
  /// kBusy while it is being stopped.
  void AskToStart(Done done);
  /// Asks the run to exit, if there is one; the state is kStopped afterwards.
  void Stop(Done done = {});
  /// From now on it is not started again by itself, and counts as stopped when it ends.
  void StopRestarting();
  /// Ends the run by force, as if it had crashed. False if there is no process.
  bool Kill(const std::string& why);
  /// Once stopped, goes on as this configuration says; none: it is to be forgotten.
  void Replace(std::optional<ModuleConfig> config);
  /// Takes over what Replace was given. True if it is now kWaiting, under a new configuration.
  bool TakeReplacement();
  /// The hub knows what the module is.
  void OnPresent();

  const ModuleConfig& config() const { return config_; }
  State state() const { return state_; }
  bool has_run() const { return run_ != nullptr; }
  bool has_process() const { return run_ != nullptr && run_->is_process(); }
  bool removed() const { return removed_; }
  /// True once Replace was called and until it has stopped.
  bool has_replacement() const { return removed_ || replacement_.has_value(); }
  ModuleStatus Status() const;
  const ModuleOutput& output() const { return output_; }

 private:
  ModuleRun::Events RunEvents();
  void OnJoined();
  void OnOutput(OutputLine line);
  void Hold(OutputLine line);
  /// What was held back is told, at the level it had or as this one.
  void LetGo(const std::string& level = "INFO");
  void Tell(const OutputLine& line);
  void OnReady();
  void OnEnded(const ModuleRun::Ending& ending);
  void Notice(const std::string& text) { events_.on_notice("@" + config_.name + text); }
  void Error(const std::string& text) { events_.on_notice("error: @" + config_.name + text); }
  /// `reason`: what its last line said, after a colon; may be empty.
  void RestartByPolicy(const std::string& how, bool failed, const std::string& reason);
  void GiveUp(State state, const std::string& why);
  void Stopped();

  boost::asio::io_context& io_;
  Hub& hub_;
  ChildReaper& reaper_;
  ModuleConfig config_;
  const Events& events_;
  State state_ = State::kWaiting;
  std::shared_ptr<ModuleRun> run_;
  std::shared_ptr<HealthMonitor> monitor_;
  boost::asio::steady_timer restart_timer_, hold_timer_;
  std::vector<OutputLine> held_;
  std::chrono::steady_clock::time_point started_{};
  bool holds_ = false;         // it has just been started
  bool failed_start_ = false;  // the last run ended so; its last lines may still come
  bool spoke_ = false;         // any run of it, since somebody started it by hand
  RestartHistory history_;
  bool watch_health_ = true;
  bool restarts_ = true;
  unsigned starts_ = 0;
  unsigned failed_starts_ = 0;  // since it was ready the last time
  std::string ending_;
  bool failed_ = false;
  ModuleOutput output_;
  std::vector<Done> wait_for_stop_, wait_for_ready_;
  std::optional<ModuleConfig> replacement_;
  bool removed_ = false;
};

}  // namespace am
