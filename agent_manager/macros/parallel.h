#pragma once

#include <deque>
#include <string>

#include "agent_manager/macros/own_machine.h"
#include "agent_manager/routing/hub.h"

namespace am {

/// The original's @PAR: a list of lines that are said in step with the start of speech. `set Init =
/// 1` clears it, each `set Cmd = ...` appends `sleep SECONDS` or a line with a receiver, and it
/// begins when the voice says that it speaks. Lines are said as whoever appended them. Thread: the
/// scheduler's. Limits: kMaxCommands.
class Parallel final : public OwnMachine {
 public:
  static constexpr std::size_t kMaxCommands = 256;
  Parallel(vm::Scheduler& clock, Hub& hub);
  ~Parallel() override;
  Parallel(const Parallel&) = delete;

  vm::SlotMachine& slots() override { return slots_; }
  void Handle(const Envelope& envelope) override;
  void OnReport(const std::string& from, const vm::Message& message) override;
  void OnPresence(const std::string&, bool, const std::string&) override {}
  void Abandon(const vm::Error&) override {}
  bool Owes(PeerKey) const override { return false; }
  bool Busy() const override { return timer_ != 0; }

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
