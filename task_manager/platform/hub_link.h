#pragma once

#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "task_manager/platform/platform.h"
#include "vm_protocol/core/client.h"
#include "vm_protocol/runtime/credentials.h"

namespace vxml {

/// Where the hub is and what is shown to it.
struct HubAddress {
  std::string endpoint;  ///< unix:PATH, tcp:HOST:PORT or tls:HOST:PORT
  vm::Credentials credentials;
};

/// So long an answer of a module is waited for.
inline constexpr Millis kAnswer{5000};

/// A connection to the hub used by one session, with blocking waits.
/// Thread: the session's. What is sent goes out together at the next wait: between two lines of one
/// packet a virtual clock does not move. Limits: those of StreamPeer; a line over them is left out.
class HubLink {
 public:
  /// Throws std::runtime_error with a sentence if the hub cannot be reached. `keyboard` reads
  /// lines from standard input beside the hub's.
  HubLink(const HubAddress& hub, const std::string& name, bool keyboard);
  ~HubLink();
  HubLink(const HubLink&) = delete;
  HubLink& operator=(const HubLink&) = delete;

  vm::Client& client() { return *client_; }
  /// Ours at the hub.
  const std::string& name() const { return name_; }
  void Send(const std::string& line);
  /// Hands over what was sent, before work that takes long.
  void Flush();
  /// Asks and waits for the answer. Errors: the refusal, kTimeout, kUnavailable (the hub is gone).
  vm::Result<std::string> Ask(const std::string& line, Millis limit);
  /// Handles what comes until `done` says so or the time is up. False at the time limit.
  bool WaitFor(const std::function<bool()>& done, std::optional<Millis> limit);
  bool gone() const { return gone_; }
  /// Nothing that comes is handed over any more: who asked for it goes before this link.
  void StopListening();

  /// From now on hub_time() is known: the hub shows all that is said with its time. False if it
  /// does not allow that.
  bool WatchTime();
  /// On the hub's clock, of what came last; nothing without WatchTime.
  std::optional<Millis> hub_time() const { return hub_time_; }

  /// A typed line. False: there is nothing in it.
  std::function<bool(const std::string& line)> on_typed;
  enum class CutIn {
    kNone,  ///< what is typed waits
    kNext,  ///< the next line typed is handed over at once; further ones wait
    kAll,   ///< whatever is typed is handed over at once: what is said and keyed while recording
  };
  /// Lines that came before wait in any case.
  void LetCutIn(CutIn may) { cut_in_ = may; }
  /// Somebody listens: the line typed first of those that wait is handed over, if it has something
  /// in it, with kAll also the commands (/...) right behind it. A file has all its lines at once,
  /// typing ahead some; at most kMostTyped wait here.
  void TakeTyped();
  /// Typing is over: the file is read, a terminal's user ended it, or a pipe that had lines. From
  /// an empty standard input nothing was to be expected, the ear alone counts.
  bool typed_end() const { return typed_end_ && typed_lines_.empty(); }

 private:
  void Pump(Millis limit);
  void OnLine(std::string_view line);
  void WaitForKeys();
  bool ReadTyped();  ///< false at the end
  /// Takes that line out of those that wait. False: there was nothing in it.
  bool HandOver(std::size_t index);

  struct Channel;
  static constexpr std::size_t kMostTyped = 1000;
  static constexpr std::size_t kMostTypedBytes = std::size_t{64} << 10;  ///< of one line
  const std::string name_;
  bool keyboard_;
  std::unique_ptr<Channel> channel_;
  bool keys_from_file_ = false;
  bool waits_for_keys_ = false;
  CutIn cut_in_ = CutIn::kNone;
  bool typed_any_ = false;
  bool typed_end_ = false;
  bool gone_ = false;
  bool listening_ = true;
  std::string typed_;  ///< of a line that has no end yet
  std::deque<std::string> typed_lines_;
  std::optional<Millis> hub_time_;
  std::unique_ptr<vm::Client> client_;
};

}  // namespace vxml
