#pragma once

#include <boost/asio/io_context.hpp>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "agent_manager/routing/hub.h"
#include "vm_protocol/runtime/stream_peer.h"

namespace am {

/// The peer @CONSOLE: stdin and stdout. Its lines are said one after the other, once all modules
/// have started, and not while `set Wait` holds them. To people it says what it knows on `help`,
/// and ends the hub on `quit`. Thread: the context's. Limits: kMaxLines lines are read ahead.
class Console {
 public:
  static constexpr std::size_t kMaxLines = 256;
  struct Hooks {
    std::function<bool()> started;  ///< lines can be said
    std::function<void()> on_said;  ///< after each
    std::function<void()> on_quit;
    std::function<void(const std::string& line)> on_told;  ///< each message to it
    std::function<void(const std::string& why)> on_lost;   ///< what is said cannot be written
  };
  Console(boost::asio::io_context& io, vm::Scheduler& clock, Hub& hub, Hooks hooks);

  /// `first_lines` are said before its own input.
  void Start(const std::vector<std::string>& first_lines);
  /// Lines that wait are said until one asks to wait.
  void Feed();
  /// The slot Wait of @AM.
  void AskWait(const vm::SetValue& value, const vm::Reply& reply);
  /// Nothing goes on any more: who waits for that goes on.
  void OnIdle();

  PeerKey key() const { return key_; }
  bool started() const { return stream_ != nullptr; }
  bool has_lines() const { return !lines_.empty(); }
  bool input_ended() const { return ended_; }
  bool waits_for_idle() const { return idle_wait_.has_value(); }
  bool waits_for_time() const { return timed_wait_; }

 private:
  void OnLine(vm::Result<std::string_view> line);
  bool TakeWord(const std::string& line);
  void Help(const std::string& name);

  boost::asio::io_context& io_;
  vm::Scheduler& clock_;
  Hub& hub_;
  Hooks hooks_;
  std::shared_ptr<vm::StreamPeer> stream_;
  PeerKey key_ = kHub;
  std::deque<std::string> lines_;
  bool ended_ = false;
  bool saying_ = false;  // a line is on its way through the queue
  std::optional<vm::Reply> idle_wait_;
  bool timed_wait_ = false;
};

}  // namespace am
