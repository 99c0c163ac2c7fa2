#include "vdm/core/session_clock.h"

#include <algorithm>
#include <utility>

namespace vdm {
namespace {
constexpr std::size_t kMostAsked = 8;  // older questions are not answered any more
}

SessionClock::SessionClock(vm::Scheduler& scheduler, vm::SlotMachine& slots,
                           std::function<bool()> shared)
    : scheduler_(scheduler), slots_(slots), shared_(std::move(shared)) {}

void SessionClock::Start() {
  Stop();
  questions_ = 0;
  Ask();
}

void SessionClock::Stop() {
  if (timer_ != 0) scheduler_.Cancel(std::exchange(timer_, 0));
}

void SessionClock::Ask() {
  timer_ = 0;
  if (shared_()) return;
  const std::string tag = "vdm" + std::to_string(questions_++);
  if (asked_.size() >= kMostAsked) asked_.clear();
  asked_[tag] = scheduler_.Now();
  vm::Message question = vm::To("AM", vm::Inq("Clock"));
  question.tag = tag;
  slots_.Say(std::move(question));
  timer_ = scheduler_.After(questions_ < kQuick ? kAtFirst : kEvery, [this] { Ask(); });
}

void SessionClock::Hear(const vm::Message& message) {
  const auto question = asked_.find(message.tag);
  if (message.command != vm::Command::kRep || message.slot != "Clock" || question == asked_.end()) {
    return;
  }
  if (const auto theirs = vm::ParseMs(message.value)) {
    estimate_.Add(question->second, scheduler_.Now(), *theirs);
  }
  asked_.erase(question);
}

std::string SessionClock::StartText(vm::Time at) const {
  if (shared_()) return "@" + vm::FormatMs(at);
  if (estimate_.known()) return "@" + vm::FormatMs(at + estimate_.offset());
  return "+" + vm::FormatMs(std::max(at - scheduler_.Now(), vm::Time(0)));
}

}  // namespace vdm
