#pragma once

#include <functional>
#include <map>
#include <string>

#include "vm_protocol/core/clock_estimate.h"
#include "vm_protocol/core/scheduler.h"
#include "vm_protocol/core/slot_machine.h"

namespace vdm {

/// Where the hub's clock stands, asked of the hub while it is needed (`to @AM inq#... Clock`), so
/// that an instant can be told to another module by `@T`. Without a hub nobody answers.
/// Lifetime: what it is made with outlives it. Thread: the scheduler's.
class SessionClock {
 public:
  static constexpr vm::Time kEvery{2'000'000};
  static constexpr vm::Time kAtFirst{50'000};  ///< between the first kQuick questions
  static constexpr int kQuick = 5;

  /// `shared`: whether this process's clock is the session's already (a virtual one).
  SessionClock(vm::Scheduler& scheduler, vm::SlotMachine& slots, std::function<bool()> shared);
  ~SessionClock() { Stop(); }
  SessionClock(const SessionClock&) = delete;

  void Start();
  void Stop();
  /// What other modules say to us; answers to questions are taken out of it.
  void Hear(const vm::Message& message);
  /// A start time that means the instant `at` of our clock wherever it is read: `@T` where the
  /// session's clock is known, else `+MS` from now.
  std::string StartText(vm::Time at) const;

 private:
  void Ask();
  vm::Scheduler& scheduler_;
  vm::SlotMachine& slots_;
  const std::function<bool()> shared_;
  vm::ClockEstimate estimate_;
  std::map<std::string, vm::Time> asked_;  // by tag; the last few
  int questions_ = 0;
  vm::TimerId timer_ = 0;
};

}  // namespace vdm
