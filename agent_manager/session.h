#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/signal_set.hpp>
#include <boost/asio/steady_timer.hpp>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "agent_manager/config.h"
#include "agent_manager/hub.h"
#include "agent_manager/log_writer.h"
#include "agent_manager/mcl.h"
#include "agent_manager/session_log.h"
#include "agent_manager/supervisor.h"
#include "vm_protocol/core/slot_machine.h"
#include "vm_protocol/runtime/asio_scheduler.h"
#include "vm_protocol/runtime/doorkeeper.h"

namespace am {

class WebServer;
namespace mqtt {
class Bridge;
}

/// The content of a file. Throws std::runtime_error with a sentence.
std::string ReadWhole(const std::string& path);

/// The hub at work: configuration, clock, modules, sockets, console, and the end of it all.
/// Owns everything. Thread: the one that calls Run.
class Session {
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
  Session(Config config, Options options);
  ~Session();
  /// Returns the exit code.
  int Run();
  /// The slots of @AM and @AM-MCL for docs/slots.md.
  std::string SlotsMarkdown() const;

 private:
  // session_slots.cc
  void DeclareSlots();
  void DeclareModuleSlots();
  void DeclareLimitSlots();  // session_peers.cc
  /// Module.NAME.state and so on, for modules that have none yet.
  void DeclareSlotsOf(const std::string& module);
  // session_config.cc: what the configuration says, at the start and when it is read again.
  void ApplyConfig();
  void Listen();
  void JoinBroker();
  void OnGuest(const vm::Doorkeeper::Guest& guest);
  void Refused(const std::string& text);
  void ReloadOnSignal();
  vm::Result<std::string> Reload();
  // session_console.cc
  void StartConsole();
  void OnConsoleLine(vm::Result<std::string_view> line);
  /// Lines of the console that are waiting are said until one asks to wait.
  void FeedConsole();
  void AskWait(const vm::SetValue& value, const vm::Reply& reply);
  void LoadReplay(const std::string& path);
  void StartReplay();
  bool Started() const;
  bool SomethingGoesOn() const;
  void CheckIdleWait();
  /// Real clock: finds out whether the modules are idle, while somebody wants to know.
  void AskQuiet();
  bool Over() const;
  // Lockstep: see docs/architecture.md "Time".
  void StepVirtual();
  void GrantAll(vm::Time time);
  void OnClockAnswer(PeerKey module, const vm::Result<std::string>& answer);
  /// Waits for something to do, and does it.
  void RunSome();
  void Shutdown();
  void FeedWatchdog();
  void ShowOnlookers(std::string_view line);
  void FlushLog();
  void StartWeb();
  std::string Metrics() const;  // session_peers.cc
  /// A module that has been asked for a whole start_limit without an answer is one of the original.
  void EndProbesInTime(const std::set<PeerKey>& asked_before);

  struct QuietRound {
    std::size_t open;
    bool busy;
  };
  struct NextEvent {
    std::optional<vm::Time> at;
    bool busy = false;
  };

  Config config_;
  Options options_;
  boost::asio::io_context io_;
  vm::ClockScheduler clock_;
  std::unique_ptr<LogWriter> log_writer_;
  std::set<PeerKey> onlookers_;  // to whom every message is shown
  SessionLog log_;
  Hub hub_;
  vm::SlotMachine slots_;
  Mcl mcl_;
  Supervisor supervisor_;
  std::vector<std::pair<ListenConfig, std::unique_ptr<vm::Doorkeeper>>> doors_;
  std::shared_ptr<vm::StreamPeer> console_stream_;
  PeerKey console_ = 0;
  std::deque<std::string> console_lines_;
  bool console_ended_ = false;
  std::optional<vm::Reply> idle_wait_;
  bool timed_wait_ = false;
  std::vector<LogEntry> replay_;
  std::size_t replay_pending_ = 0;
  boost::asio::steady_timer probe_timer_, grant_timer_, watchdog_timer_, log_timer_;
  std::unique_ptr<WebServer> web_;
  std::unique_ptr<mqtt::Bridge> mqtt_;
  MqttConfig joined_;  // as mqtt_ was made
  boost::asio::signal_set reload_signal_;
  std::map<PeerKey, NextEvent> next_;
  std::set<PeerKey> open_grants_;
  vm::Time granted_{-1};
  bool started_once_ = false;
  bool quiet_ = false;  // real clock: all modules said IDLE after the last line that was said
  bool asking_quiet_ = false;
  bool stop_ = false;
  int errors_ = 0;
  unsigned long refused_ = 0;
};

}  // namespace am
