#include "agent_manager/supervision/health_monitor.h"

#include <utility>

#include "agent_manager/routing/own_names.h"

namespace am {

namespace {

constexpr std::chrono::milliseconds kAskReadyAgain{200};

}  // namespace

HealthMonitor::HealthMonitor(boost::asio::io_context& io, Hub& hub, const ModuleConfig& module,
                             Events events)
    : hub_(hub), config_(module), events_(std::move(events)), limit_(io), timer_(io) {}

void HealthMonitor::Start(bool watch) {
  watch_ = watch;
  phase_ = Phase::kUnknown;
  limit_.expires_after(config_.ready_within);
  limit_.async_wait([self = weak_from_this()](const auto& error) {
    const auto monitor = self.lock();
    if (!error && monitor && monitor->phase_ < Phase::kReady)
      monitor->Fail("not ready within " + vm::FormatMs(monitor->config_.ready_within) + " ms");
  });
  if (hub_.directory().IsReady(config_.name)) OnPresent();
}

void HealthMonitor::OnPresent() {
  if (phase_ != Phase::kUnknown) return;
  phase_ = Phase::kAskingReady;
  AskReady();
}

void HealthMonitor::Stop() {
  phase_ = Phase::kStopped;
  limit_.cancel();
  timer_.cancel();
}

void HealthMonitor::After(std::chrono::milliseconds delay, void (HealthMonitor::*act)()) {
  timer_.expires_after(delay);
  timer_.async_wait([self = weak_from_this(), act, phase = phase_](const auto& error) {
    const auto monitor = self.lock();
    if (!error && monitor && monitor->phase_ == phase) (monitor.get()->*act)();
  });
}

void HealthMonitor::AskReady() {
  if (config_.ready_slot.empty()) return BecomeReady();
  hub_.Ask(own_name::kHub, vm::To(config_.name, vm::Inq(config_.ready_slot)),
           [self = weak_from_this()](const vm::Result<std::string>& value) {
             const auto monitor = self.lock();
             if (!monitor || monitor->phase_ != Phase::kAskingReady) return;
             if (value && *value == monitor->config_.ready_value) return monitor->BecomeReady();
             monitor->After(kAskReadyAgain, &HealthMonitor::AskReady);
           });
}

void HealthMonitor::BecomeReady() {
  phase_ = Phase::kReady;
  limit_.cancel();
  if (watch_ && config_.health.every.count() > 0) WaitForNextCheck();
  events_.on_ready();
}

void HealthMonitor::WaitForNextCheck() { After(config_.health.every, &HealthMonitor::Check); }

void HealthMonitor::Check() {
  answered_ = false;
  // A refusal is an answer too.
  hub_.Ask(own_name::kHub, vm::To(config_.name, vm::Inq("Run")),
           [self = weak_from_this()](const vm::Result<std::string>&) {
             const auto monitor = self.lock();
             if (!monitor) return;
             monitor->answered_ = true;
             monitor->misses_ = 0;
           });
  After(config_.health.within, &HealthMonitor::EndCheck);
}

void HealthMonitor::EndCheck() {
  if (!answered_ && ++misses_ >= config_.health.misses)
    return Fail("did not answer inq Run " + std::to_string(misses_) + " times in a row");
  WaitForNextCheck();
}

void HealthMonitor::Fail(const std::string& why) {
  Stop();
  events_.on_unwell(why);
}

}  // namespace am
