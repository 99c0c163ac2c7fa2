#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>

#include "agent_manager/routing/hub.h"
#include "vm_protocol/runtime/asio_scheduler.h"

namespace am {

/// The virtual clock of all modules, in lockstep (docs/architecture.md "Time"): grants each module
/// time, and goes on to the next event once all have answered. Thread: the context's.
class Lockstep {
 public:
  /// Told of a module that does not follow the clock, and of what it does instead: it does not
  /// answer within kPatience of real time, or names a next event that is over kMaxStaleEvents times
  /// in a row, so that time would stand still.
  using OnLost = std::function<void(PeerKey module, const std::string& why)>;
  static constexpr std::chrono::milliseconds kPatience{60000};
  static constexpr int kMaxStaleEvents = 1000;
  Lockstep(boost::asio::io_context& io, vm::ClockScheduler& clock, Hub& hub, OnLost on_lost);

  /// True while a module has not answered.
  bool Waiting() const { return !open_.empty(); }
  /// Does what is due at this instant. False if there is nothing left to do at it.
  bool StepNow();
  /// Goes on to the next event. False if there is none.
  bool StepOn();
  /// True if a module says that it has something to do.
  bool Busy() const;
  /// A module has come: what the others said of their next events is old.
  void Forget() { next_.clear(); }
  /// Those that have gone have no next event, and are not busy.
  void ForgetGone();

 private:
  struct NextEvent {
    std::optional<vm::Time> at;
    bool busy = false;
    int stale = 0;  ///< answers in a row that named an event not after what was granted
  };
  void GrantAll(vm::Time time);
  void OnAnswer(PeerKey module, const vm::Result<std::string>& answer);

  vm::ClockScheduler& clock_;
  Hub& hub_;
  OnLost on_lost_;
  boost::asio::steady_timer patience_;
  std::map<PeerKey, NextEvent> next_;
  std::set<PeerKey> open_;
  vm::Time granted_{-1};
};

}  // namespace am
