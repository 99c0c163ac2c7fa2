#pragma once

#include <unistd.h>

#include <array>
#include <boost/asio/io_context.hpp>
#include <boost/asio/signal_set.hpp>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "agent_manager/live_config.h"
#include "agent_manager/log/log_writer.h"
#include "agent_manager/log/session_log.h"
#include "agent_manager/macros/macro_layer.h"
#include "agent_manager/macros/parallel.h"
#include "agent_manager/macros/sound_player.h"
#include "agent_manager/routing/hub.h"
#include "agent_manager/session/console.h"
#include "agent_manager/session/error_stream.h"
#include "agent_manager/session/flow_watchers.h"
#include "agent_manager/session/listeners.h"
#include "agent_manager/session/lockstep.h"
#include "agent_manager/session/periodic_task.h"
#include "agent_manager/session/quiet_watch.h"
#include "agent_manager/session/replay.h"
#include "agent_manager/session/told_errors.h"
#include "agent_manager/slots/built_in_dispatcher.h"
#include "agent_manager/slots/hub_slots.h"
#include "agent_manager/supervision/supervisor.h"
#include "agent_manager/web/web_server.h"
#include "vm_protocol/runtime/asio_scheduler.h"

namespace am {

/// The hub at work: puts its parts together, runs the one loop they live on, applies the
/// configuration, and ends it all in order. Owns everything. Thread: the one that calls Run.
class AgentManager {
 public:
  struct Options {
    bool console = true;  ///< stdin and stdout are the peer @CONSOLE
    bool serve = false;   ///< go on after the console's input has ended
    bool strict = false;
    std::vector<std::string> first_lines;  ///< said by @CONSOLE before its own input
    std::optional<std::string> replay;     ///< a session log whose clients' lines are said again
    double replay_speed = 1;
    /// Reads the configuration again (SIGHUP, `set Reload = NOW`); empty = there is none to read.
    std::function<vm::Result<Config>()> read_config;
  };
  /// Throws std::runtime_error with a sentence.
  AgentManager(Config config, Options options);
  ~AgentManager();
  AgentManager(const AgentManager&) = delete;
  /// Returns the exit code.
  int Run();
  /// The slots of the hub's own machines for docs/reference/slots.md.
  std::string SlotsMarkdown();

 private:
  // Making it.
  HubSlots::Hooks SlotHooks();
  Console::Hooks ConsoleHooks();
  LiveConfig::Parts ConfigParts();
  void ConnectParts();
  void LoadBuiltInMacros();
  void StartReplay();
  // The loop.
  void Step();
  void RunSome();
  void StepVirtual();
  bool Started() const;
  bool SomethingGoesOn() const;
  bool IdleIsWanted() const;
  bool Over() const;
  void OnStarted();
  void Shutdown();
  // What begins with Run and goes on beside it.
  void StartTasks();
  void EndProbesInTime();
  void OpenPage();
  void ReloadOnSignal();
  vm::Result<std::string> Reload();
  // What parts say to people and to each other.
  void Say(const std::string& text);
  void SayError(const std::string& text, PeerKey about = kHub);
  /// What `act` throws is said; the session goes on.
  template <typename Act>
  void Guarded(const Act& act);
  void Refused(const std::string& text);
  void OnModuleOutput(const std::string& module, const OutputLine& line);
  void SayUnlessTold(const std::string& text);
  void OnModuleWithoutClock(PeerKey module, const std::string& why);
  void OnPresence(const std::string& name, bool present, const std::string& reason);
  void OnSlotError(PeerKey peer, const std::string& line, const vm::Error& error);
  void EnableLog();
  std::string Metrics() const;

  Options options_;
  boost::asio::io_context io_;
  vm::ClockScheduler clock_;
  ErrorStream people_{STDERR_FILENO};
  ToldErrors told_;
  std::unique_ptr<LogWriter> log_writer_;
  FlowWatchers flow_watchers_;
  SessionLog log_;
  Hub hub_;
  vm::SlotMachine slots_;
  MacroLayer macros_;
  Parallel parallel_;
  SoundPlayer sounds_;
  const std::array<BuiltInMachine*, 3> built_in_machines_{&macros_, &parallel_, &sounds_};
  Supervisor supervisor_;
  Console console_;
  HubSlots hub_slots_;
  BuiltInDispatcher dispatcher_;
  Listeners listeners_;
  Lockstep lockstep_;
  QuietWatch quiet_;
  LiveConfig config_;
  std::optional<Replay> replay_;
  std::unique_ptr<WebServer> web_;
  PeriodicTask end_probes_, measure_clocks_, feed_watchdog_, flush_log_;
  boost::asio::signal_set reload_signal_;
  std::set<PeerKey> probed_;  // modules that were being asked when probes were ended the last time
  bool started_once_ = false;
  bool stop_ = false;
  bool console_lost_ = false;
  const bool person_;  // reads both stdout and stderr
  std::uint64_t errors_ = 0, refused_ = 0;
};

}  // namespace am
