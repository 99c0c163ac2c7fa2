#pragma once

#include <boost/asio/io_context.hpp>
#include <deque>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "agent_manager/config/config.h"
#include "agent_manager/routing/hub.h"
#include "vm_protocol/runtime/stream_peer.h"

namespace am {

/// A line of a module's stderr.
struct OutputLine {
  std::string level;  ///< ERROR, WARNING or INFO, from the words at its beginning
  std::string text;
};
/// "fsm: error: no display" is an ERROR; what says nothing about itself is INFO.
std::string LevelOf(std::string_view line);

/// What there is to know about one configured module.
struct ModuleStatus {
  std::string name;
  std::string state;    ///< WAITING STARTING READY RESTARTING STOPPING STOPPED ENDED FAILED
  pid_t pid = -1;       ///< -1: no process
  unsigned starts = 0;  ///< in all
  std::string ending;   ///< how it ended the last time; empty = it never did
};

/// Starts the modules of the configuration in their order, joins them to the hub, watches their
/// health, starts them again by their policy, and ends them in order. Real time: processes live in
/// it even when the session's clock is virtual. A module that ends before it is ready so often as
/// kFailedStarts says, or whose program cannot be run at all, is not started again by itself.
/// Ownership: owns the processes; children die with the hub. Thread: the context's.
/// Limits: kMaxOutputLines of stderr are kept for each module; restarts by RestartPolicy.
class Supervisor {
 public:
  static constexpr std::size_t kMaxOutputLines = 200;
  static constexpr unsigned kFailedStarts =
      3;  ///< one after the other, with an exit code of its own
  using OnNotice = std::function<void(const std::string& text)>;
  using OnOutput = std::function<void(const std::string& module, const OutputLine& line)>;
  using Done = std::function<void(vm::Result<std::string> state)>;
  Supervisor(boost::asio::io_context& io, Hub& hub, OnNotice on_notice, OnOutput on_output);
  ~Supervisor();
  Supervisor(const Supervisor&) = delete;

  /// Makes what runs agree with `modules`: starts what is new, stops what is gone, restarts what is
  /// configured otherwise, leaves the rest alone. The first call throws std::runtime_error with a
  /// sentence if a program cannot be started at all; later ones report that and try again.
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
  /// False for a module that has ended and will not come back by itself, or that is connected to.
  bool IsExpected(const std::string& name) const;
  /// True if all that is expected is ready.
  bool AllReady() const;
  /// Ends a module by force, as if it had crashed. False if it is no process of ours.
  bool Kill(const std::string& name, const std::string& why);
  std::vector<ModuleStatus> Status() const;
  /// The last lines of a module's stderr, oldest first.
  std::deque<OutputLine> Output(const std::string& name) const;

 private:
  struct Child;
  using ChildPtr = std::shared_ptr<Child>;
  enum class State;
  static std::string StateName(State state);
  ChildPtr Find(const std::string& name) const;
  // supervisor.cc: the life of a process.
  void StartWhatCan();
  void Start(const ChildPtr& child);
  void Spawn(const ChildPtr& child);
  void Dial(const ChildPtr& child);
  void Join(const ChildPtr& child, std::shared_ptr<vm::StreamPeer> stream);
  void ReadErrors(const ChildPtr& child, int fd);
  void OnEnd(const ChildPtr& child, const std::string& reason);
  void OnSignal();
  void Reap(const ChildPtr& child, int status);
  /// It is no peer any more once the hub's queue comes to it; then `next` goes on.
  void LeaveHub(const ChildPtr& child, const std::string& reason, std::function<void()> next);
  void Ended(const ChildPtr& child, const std::string& how, bool failed);
  void GiveUp(const ChildPtr& child, State state, const std::string& how);
  // supervisor_watch.cc: readiness and health.
  void AwaitReady(const ChildPtr& child);
  void AskReady(const ChildPtr& child);
  void BecomeReady(const ChildPtr& child);
  void WatchHealth(const ChildPtr& child);
  void AskHealth(const ChildPtr& child);
  void KillChild(const ChildPtr& child, const std::string& why);
  bool MayStart(const Child& child) const;
  bool IsExpected(const Child& child) const;
  // supervisor_stop.cc: orderly ends, and changes of the configuration.
  void AskToStop(const ChildPtr& child);
  void Stopped(const ChildPtr& child);
  void StopNext();

  boost::asio::io_context& io_;
  Hub& hub_;
  OnNotice on_notice_;
  OnOutput on_output_;
  std::vector<ChildPtr> children_;
  struct Signals;
  std::unique_ptr<Signals> signals_;
  bool watch_health_ = true;
  bool first_apply_ = true;
  bool stopping_ = false;
  std::function<void()> on_stopped_;
};

}  // namespace am
