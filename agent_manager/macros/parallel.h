#pragma once

#include <deque>
#include <string>

#include "agent_manager/routing/hub.h"
#include "vm_protocol/core/slot_machine.h"

namespace am {

/// The original's @PAR: a list of lines that are said in step with the start of speech. `set Init =
/// 1` clears it, each `set Cmd = ...` appends `sleep SECONDS` or a line with a receiver, and it
/// begins when the voice says that it speaks. Lines are said as whoever appended them. Thread: the
/// scheduler's. Limits: kMaxCommands.
class Parallel {
 public:
  static constexpr std::size_t kMaxCommands = 256;
  Parallel(vm::Scheduler& clock, Hub& hub);
  ~Parallel();
  Parallel(const Parallel&) = delete;

  vm::SlotMachine& slots() { return slots_; }
  /// Deals with a message to @PAR.
  void Handle(const Envelope& envelope);
  /// Feed what modules say.
  void OnReport(const std::string& from, const vm::Message& message);
  /// True while the list is being said.
  bool Busy() const { return timer_ != 0; }

 private:
  struct Command {
    vm::Time sleep{0};
    vm::Message message;  ///< where sleep is 0
    Origin origin;
  };
  vm::Result<std::string> Append(const std::string& text);
  void Go();

  vm::Scheduler& clock_;
  Hub& hub_;
  vm::SlotMachine slots_;
  std::deque<Command> commands_;
  Origin origin_;  // of the message being handled
  vm::TimerId timer_ = 0;
};

}  // namespace am
