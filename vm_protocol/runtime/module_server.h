#pragma once

#include <boost/asio/io_context.hpp>
#include <chrono>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "vm_protocol/core/module.h"
#include "vm_protocol/runtime/asio_scheduler.h"
#include "vm_protocol/runtime/endpoint.h"
#include "vm_protocol/runtime/stream_peer.h"

namespace vm {

/// Joins a module to its peers and to time: carries lines both ways, keeps the slots Clock,
/// Clock.mode and Wait, and knows when everything is done.
/// Lifetime: the module, scheduler and context outlive it. Thread: the context's.
class ModuleServer {
 public:
  struct Options {
    std::string program_name{};  ///< in front of every line on stderr
    bool one_client = false;     ///< the original's socket mode: a second client is closed at once
    bool original_socket_words = false;  ///< `set Run = CLOSE` and `CloseSocket` end a connection
  };
  ModuleServer(boost::asio::io_context& io, ClockScheduler& clock, Module& module, Options options);
  ~ModuleServer();
  ModuleServer(const ModuleServer&) = delete;

  struct PeerOptions {
    std::vector<std::string> first_lines{};  ///< sent before the greeting
    bool ends_module = false;    ///< its end of input ends the module, once nothing is pending
    bool wants_errors = false;   ///< as if it had said `prop Error = AutoOutput`
    std::string already_read{};  ///< bytes of its input read before it came here
  };
  void AddPeer(std::shared_ptr<StreamPeer> stream, PeerOptions options);
  /// True if another client may come in now.
  bool HasRoom() const;

  /// Runs until the module is told to exit, or its input has ended and nothing is pending; then
  /// shuts the module down and flushes. Returns the number of errors seen.
  int Run();
  /// Makes Run return soon, whatever goes on. Safe within callbacks.
  void RequestStop() { stop_ = true; }
  bool stopping() const { return stop_; }
  /// True if the peer whose end ends the module was lost: no orderly end.
  bool failed() const { return failed_; }

 private:
  struct Peer {
    std::shared_ptr<StreamPeer> stream;
    bool ends_module = false;
    bool called = false;  // we have called it, and spoken first
    bool heard = false;   // it has said something
    bool ended = false;   // its input is; it is kept for what is still said to it
    std::chrono::steady_clock::time_point kept_until{};
    bool waiting = false;          // a `Wait` holds its input
    std::optional<Reply> on_idle;  // it waits for IDLE
  };

  void DeclareSlots();
  Result<std::string> SetClock(const SetValue& value);
  void SetWait(const SetValue& value, const Reply& reply);
  void EndWait(PeerId id, const Reply& reply);
  std::string ClockText() const;
  void OnLine(PeerId id, Result<std::string_view> line);
  void OnEnd(PeerId id, const StreamEnd& end);
  void Emit(PeerId id, const Message& message);
  void Release(PeerId id);
  void Step();
  /// True if something goes on only when the module is no longer busy.
  bool IdleIsAwaited() const;
  /// After anything happened: ends waits for IDLE, and says whether all is over.
  bool Settle();
  bool TimeIsWanted() const;
  void Finish();
  void Complain(std::string_view text) const;

  boost::asio::io_context& io_;
  ClockScheduler& clock_;
  Module& module_;
  Options options_;
  std::map<PeerId, Peer> peers_;
  PeerId last_peer_ = 0;
  bool hub_clock_ = false;
  bool module_ending_ = false;  // a peer whose end ends the module is gone
  bool stop_ = false;
  bool failed_ = false;
  std::vector<std::function<void()>> held_exits_;  // `set Run = EXIT` said while something goes on
  int errors_ = 0;
};

}  // namespace vm
