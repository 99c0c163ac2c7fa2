#pragma once

#include <boost/asio/steady_timer.hpp>
#include <csignal>
#include <deque>
#include <optional>

#include "agent_manager/supervision/supervisor.h"

/// The supervisor's own view of a module, shared by the files that make it up. Not for others.
namespace am {

enum class Supervisor::State {
  kWaiting,   ///< for the modules it comes after
  kStarting,  ///< runs, not ready yet
  kReady,
  kRestarting,  ///< waits for its next start
  kStopping,    ///< was asked to exit
  kStopped,     ///< by hand
  kEnded,       ///< by itself, and its policy leaves it at that
  kFailed,      ///< started too often
};

struct Supervisor::Child {
  Child(boost::asio::io_context& io, const ModuleConfig& module)
      : config(module), restart_timer(io), stop_timer(io), ready_timer(io), health_timer(io) {}

  bool running() const { return pid > 0 || peer != 0; }
  /// To the process and what it has started itself, which are a group of their own.
  void Signal(int signal) const {
    if (pid > 0) kill(-pid, signal);
  }

  ModuleConfig config;
  State state = State::kWaiting;
  pid_t pid = -1;
  PeerKey peer = 0;
  std::shared_ptr<vm::StreamPeer> stream, errors;
  boost::asio::steady_timer restart_timer, stop_timer, ready_timer, health_timer;
  RestartHistory history;
  unsigned starts = 0;
  unsigned failed_starts = 0;  // since it was ready the last time
  unsigned health_misses = 0;
  std::string ending;      // how it ended the last time
  std::string killed_for;  // why the hub used force in this life
  std::deque<OutputLine> output;
  std::vector<Done> on_stopped;           // those who asked for a stop by hand
  std::vector<Done> on_ready;             // those who asked for a start by hand
  std::optional<ModuleConfig> successor;  // starts under this configuration once it has stopped
  bool removed = false;                   // no longer configured: forgotten once it has stopped
};

}  // namespace am
