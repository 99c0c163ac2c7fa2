#pragma once

#include <boost/asio/io_context.hpp>
#include <deque>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "agent_manager/supervision/child_reaper.h"
#include "agent_manager/supervision/managed_module.h"

namespace am {

/// The modules of the configuration: starts each once those it comes after are ready, follows
/// changes of the configuration, and ends all in order. Real time: processes live in it even when
/// the session's clock is virtual. Ownership: owns the processes; children die with the hub.
/// Thread: the context's.
class Supervisor {
 public:
  using OnNotice = std::function<void(const std::string& text)>;
  using OnOutput = std::function<void(const std::string& module, const OutputLine& line)>;
  using Done = ManagedModule::Done;
  Supervisor(boost::asio::io_context& io, Hub& hub, OnNotice on_notice, OnOutput on_output);
  Supervisor(const Supervisor&) = delete;

  /// Makes what runs agree with `modules`: starts what is new, stops what is gone, restarts what is
  /// configured otherwise, leaves the rest alone. The first call throws std::runtime_error with a
  /// sentence if a program cannot be started at all; later ones report that and go on.
  void Apply(const std::vector<ModuleConfig>& modules);
  /// Asks each module to exit, those that others come after last, waits, then uses force; `done`
  /// when all are gone.
  void StopAll(std::function<void()> done);
  /// By hand. `done` gets the new state, or why not (kUnknownModule, kBusy).
  void StartOne(const std::string& name, Done done);
  void StopOne(const std::string& name, Done done);
  void RestartOne(const std::string& name, Done done);

  /// To be told when the hub knows what a module is.
  void OnPresent(const std::string& name);
  /// Health is watched on the real clock only.
  void set_watch_health(bool watch) { watch_health_ = watch; }
  /// True if every module is ready that has not ended for good; modules that are connected to are
  /// not waited for.
  bool AllReady() const;
  /// Ends a module by force, as if it had crashed. False if it is no process of ours.
  bool Kill(const std::string& name, const std::string& why);
  std::vector<ModuleStatus> Status() const;
  /// The last lines of a module's stderr, oldest first.
  std::deque<OutputLine> Output(const std::string& name) const;

 private:
  using ModulePtr = std::shared_ptr<ManagedModule>;
  ModulePtr Find(const std::string& name) const;
  bool IsReady(const std::string& name) const;
  /// False for a module that has ended and will not come back by itself, or that is connected to.
  bool IsExpected(const ManagedModule& module) const;
  void StartWhatCan();
  void OnStopped(ManagedModule& module);
  void StopNext();

  boost::asio::io_context& io_;
  Hub& hub_;
  ChildReaper reaper_;
  const ManagedModule::Events events_;
  std::vector<ModulePtr> modules_;
  bool watch_health_ = true;
  bool first_apply_ = true;
  bool stopping_ = false;
  std::function<void()> on_all_stopped_;
};

}  // namespace am
