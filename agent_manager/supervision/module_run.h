#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>
#include <functional>
#include <memory>
#include <string>

#include "agent_manager/config/config.h"
#include "agent_manager/routing/hub.h"
#include "agent_manager/supervision/child_reaper.h"
#include "agent_manager/supervision/module_output.h"
#include "vm_protocol/runtime/stream_peer.h"

namespace am {

/// One run of a module, from its start to its end: its program is started, or a connection to it is
/// opened, and the hub gets it as a peer. However it ends, on_ended is called exactly once.
/// Ownership: owns the process and its pipes; its destructor kills the process and what that has
/// started itself. Thread: the context's. All that it is given outlives it.
class ModuleRun : public std::enable_shared_from_this<ModuleRun> {
 public:
  struct Ending {
    std::string how;            ///< "ended with code 3 (did not exit within 5000 ms)"
    bool failed = false;        ///< anything but exit code 0 or a stop that was asked for
    std::string last_output{};  ///< the last line of its stderr, if there was one
    /// Its program ended by itself with an error code.
    bool exited_with_error = false;
    bool spoke = false;  ///< it had said a line
  };
  struct Events {
    std::function<void()> on_joined;                         ///< the hub has it as a peer
    std::function<void(const OutputLine& line)> on_output;   ///< also after the end
    std::function<void(const std::string& text)> on_notice;  ///< for people
    /// From the hub's queue, after the peer has left the hub.
    std::function<void(const Ending& ending)> on_ended;
  };
  ModuleRun(boost::asio::io_context& io, Hub& hub, ChildReaper& reaper, const ModuleConfig& module,
            Events events);
  ~ModuleRun();
  ModuleRun(const ModuleRun&) = delete;

  /// Errors: kUnavailable if the program cannot be run, kBusy if the system lacks the means for
  /// now; then no event follows.
  vm::Result<void> Start();
  /// Asks the module to exit, and uses force when it does not within its `stop_within`.
  void Stop();
  /// Ends it at once; `why` becomes part of its ending.
  void Kill(const std::string& why);

  bool is_process() const { return !config_.command.empty(); }
  pid_t pid() const { return pid_; }  ///< -1: no process, or no longer

 private:
  vm::Result<void> Spawn();
  vm::Result<void> Dial();
  void Join(std::shared_ptr<vm::StreamPeer> stream);
  void ReadErrors(int fd);
  void OnInputEnd(const std::string& reason);
  void OnExit(int status);
  /// Kills the process unless it has ended by then.
  void KillAfter(std::chrono::milliseconds patience, const std::string& why, int signal);
  void Signal(int signal) const;
  void End(Ending ending);

  boost::asio::io_context& io_;
  Hub& hub_;
  ChildReaper& reaper_;
  const ModuleConfig config_;
  Events events_;
  pid_t pid_ = -1;
  PeerKey peer_ = kHub;
  std::shared_ptr<vm::StreamPeer> stream_, errors_;
  boost::asio::steady_timer kill_timer_;
  std::string killed_for_, last_output_;
  bool stopping_ = false;
  bool spoke_ = false;
  bool ended_ = false;
};

}  // namespace am
