#pragma once

#include <boost/asio/io_context.hpp>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "agent_manager/config.h"
#include "agent_manager/hub.h"
#include "vm_protocol/runtime/stream_peer.h"

namespace am {

/// A Link over a StreamPeer.
class StreamLink final : public Link {
 public:
  explicit StreamLink(std::shared_ptr<vm::StreamPeer> peer) : peer_(std::move(peer)) {}
  ~StreamLink() override { peer_->Close(); }
  void Send(std::string_view line) override { peer_->Send(line); }
  void Close() override { peer_->Close(); }

 private:
  std::shared_ptr<vm::StreamPeer> peer_;
};

/// Starts the modules of the configuration, joins them to the hub, starts them again by their
/// policy, and ends them in order. Real time: processes live in it even when the session's clock is
/// virtual. Ownership: owns the processes; children die with the hub. Thread: the context's.
/// Limits: restarts wait 0.2 s, doubling up to 10 s; more than 8 within a minute end the trying.
class Supervisor {
 public:
  using OnNotice = std::function<void(const std::string& text)>;
  Supervisor(boost::asio::io_context& io, Hub& hub, OnNotice on_notice);
  ~Supervisor();
  Supervisor(const Supervisor&) = delete;

  /// Throws std::runtime_error with a sentence if a program cannot be started at all.
  void StartAll(const std::vector<ModuleConfig>& modules);
  /// Asks each module to exit, last started first, waits, then uses force; `done` when all are
  /// gone.
  void StopAll(std::function<void()> done);
  /// False for a module that has ended and will not come back by itself, or that is connected to.
  bool IsExpected(const std::string& name) const;
  /// Ends a module by force, as if it had crashed. False if it is no process of ours.
  bool Kill(const std::string& name);
  /// "SSM RUNNING 1234, FSM RESTARTING" for people.
  std::string Summary() const;

 private:
  struct Child;
  void Start(Child& child);
  void Spawn(Child& child);
  void Dial(Child& child);
  void Join(Child& child, int read_fd, int write_fd);
  void ReadErrors(Child& child, int fd);
  void OnEnd(Child& child, const std::string& reason);
  void OnSignal();
  void Reap(Child& child, int status);
  void MaybeRestart(Child& child, bool failed);
  void StopNext();

  boost::asio::io_context& io_;
  Hub& hub_;
  OnNotice on_notice_;
  std::vector<std::unique_ptr<Child>> children_;
  struct Signals;
  std::unique_ptr<Signals> signals_;
  bool stopping_ = false;
  std::function<void()> on_stopped_;
};

}  // namespace am
