#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "task_manager/platform/platform.h"
#include "vm_protocol/core/client.h"

namespace vxml {

/// A connection to the hub used by one session, with blocking waits. Owns its socket.
/// Thread: the session's.
class HubLink {
 public:
  /// Throws std::runtime_error with a sentence if the hub cannot be reached. `keyboard` reads
  /// lines from standard input beside the hub's.
  HubLink(const std::string& endpoint, const std::string& name, bool keyboard);
  ~HubLink();
  HubLink(const HubLink&) = delete;
  HubLink& operator=(const HubLink&) = delete;

  vm::Client& client() { return *client_; }
  void Send(const std::string& line);
  /// Keeps what is sent back until the next wait, so that it arrives together: between two lines of
  /// one packet a virtual clock does not move.
  void Hold() { holding_ = true; }
  /// Asks and waits for the answer. Errors: the refusal, kTimeout, kUnavailable (the hub is gone).
  vm::Result<std::string> Ask(const std::string& line, Millis limit);
  /// Handles what comes until `done` says so or the time is up. False at the time limit.
  bool WaitFor(const std::function<bool()>& done, std::optional<Millis> limit);
  bool gone() const { return gone_; }

  std::function<void(const std::string& line)> on_typed;
  bool typed_end() const { return typed_end_; }

 private:
  bool Pump(int timeout_ms);
  void Release();
  int fd_ = -1;
  bool keyboard_;
  bool typed_end_ = false;
  bool gone_ = false;
  bool holding_ = false;
  std::string held_;
  std::string input_;
  std::string typed_;
  std::unique_ptr<vm::Client> client_;
};

}  // namespace vxml
