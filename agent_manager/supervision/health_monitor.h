#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>
#include <functional>
#include <memory>
#include <string>

#include "agent_manager/config/config.h"
#include "agent_manager/routing/hub.h"

namespace am {

/// Asks one run of a module whether it is ready and, from then on, whether it still answers, as the
/// module's `ready` and `health` say. Real clock only. Thread: the context's.
class HealthMonitor : public std::enable_shared_from_this<HealthMonitor> {
 public:
  struct Events {
    std::function<void()> on_ready;
    /// Not ready in time, or it has not answered; the monitor asks no more.
    std::function<void(const std::string& why)> on_unwell;
  };
  HealthMonitor(boost::asio::io_context& io, Hub& hub, const ModuleConfig& module, Events events);
  HealthMonitor(const HealthMonitor&) = delete;

  /// Begins; the module has just joined the hub. `watch`: go on after it is ready.
  void Start(bool watch);
  /// The hub knows what the module is, and it can be asked.
  void OnPresent();
  /// No event follows.
  void Stop();

 private:
  enum class Phase { kIdle, kUnknown, kAskingReady, kReady, kStopped };
  void AskReady();
  void BecomeReady();
  void WaitForNextCheck();
  void Check();
  void EndCheck();
  void Fail(const std::string& why);
  /// Calls `act` after `delay` if the phase is still this one.
  void After(std::chrono::milliseconds delay, void (HealthMonitor::*act)());

  Hub& hub_;
  const ModuleConfig config_;
  Events events_;
  boost::asio::steady_timer limit_, timer_;
  Phase phase_ = Phase::kIdle;
  bool watch_ = false;
  bool answered_ = false;
  unsigned misses_ = 0;
};

}  // namespace am
