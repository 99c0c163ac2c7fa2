#pragma once

#include <chrono>
#include <functional>
#include <string>

#include "vm_protocol/core/scheduler.h"
#include "vm_protocol/core/slot_machine.h"

namespace ear {

using Millis = std::chrono::milliseconds;

/// Whether an ear listens, and its patience: the slots Run, Listen, Listen.stat, Listen.timeout,
/// Listen.longest, Listen.end and the versions.
///
///   OFF --Start--> LISTENING --Hear--> SPEECH --Wait--> LISTENING     Stop from anywhere -> OFF
///
/// Thread: the scheduler's. The scheduler and the slots outlive it.
class Listening {
 public:
  struct Hooks {
    std::function<void()>
        started{};  ///< before LISTENING is reported: an engine may have to be loaded
    std::function<void()> stopped{};  ///< before OFF is reported
    std::function<void()> exit{};     ///< Run = EXIT
    std::function<bool()> hearing{};  ///< somebody is speaking just now
    std::function<void()> end{};      ///< what is being said ends here, and counts
  };
  Listening(vm::Scheduler& scheduler, vm::SlotMachine& slots, Hooks hooks);
  ~Listening() { Disarm(); }
  Listening(const Listening&) = delete;

  void Declare(const std::string& module_version);
  bool on() const { return on_; }
  /// NoInput will come if nobody speaks.
  bool armed() const { return timer_ != 0; }
  void Start();
  void Stop();
  /// Somebody speaks.
  void Hear();
  /// Nobody speaks any more; `more` follows at once, so no patience is needed.
  void Wait(bool more = false);
  /// NoInput will come after Listen.timeout from now on.
  void Arm();
  void Disarm();
  /// An utterance is ended after that.
  Millis longest() const { return longest_; }

 private:
  vm::Scheduler& scheduler_;
  vm::SlotMachine& slots_;
  const Hooks hooks_;
  bool on_ = false;
  Millis timeout_{0};
  Millis longest_{20'000};
  vm::TimerId timer_ = 0;
};

}  // namespace ear
