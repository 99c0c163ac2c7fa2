#pragma once

#include <deque>
#include <map>
#include <string>

#include "agent_manager/macros/built_in_machine.h"
#include "agent_manager/routing/hub.h"

namespace am {

/// The original's @PAR: lists of lines that are sent when speech starts, one list for each peer.
/// `set Init = 1` clears the peer's list, each `set Cmd = ...` appends `sleep SECONDS` or a line
/// with a receiver, and all lists begin when the voice reports that it speaks. Lines are sent on
/// behalf of the peer that appended them; a peer's list is deleted when it leaves. Thread: the
/// scheduler's. Limits: kMaxCommands and kMaxBytes for each peer.
class Parallel final : public BuiltInMachine {
 public:
  static constexpr std::size_t kMaxCommands = 256;
  static constexpr std::size_t kMaxBytes = 64u << 10;
  Parallel(vm::Scheduler& clock, Hub& hub);
  ~Parallel() override;
  Parallel(const Parallel&) = delete;

  vm::SlotMachine& slots() override { return slots_; }
  void Handle(const Envelope& envelope) override;
  void OnReport(const std::string& from, const vm::Message& message) override;
  void OnPresence(const std::string&, bool, const std::string&) override {}
  void Abandon(const vm::Error&) override {}
  bool IsAwaitedBy(PeerKey) const override { return false; }
  bool Busy() const override;

 private:
  struct Command {
    vm::Time sleep{0};
    vm::Message message;  ///< sent if sleep is 0
    Origin origin;
  };
  struct List {
    std::deque<Command> commands{};
    std::size_t bytes = 0;  ///< of all appended lines
    vm::TimerId timer = 0;  ///< of the current sleep
  };
  vm::Result<std::string> Append(const std::string& text);
  void Clear(PeerKey peer);
  void ForgetGone();
  void Continue(PeerKey peer);

  vm::Scheduler& clock_;
  Hub& hub_;
  vm::SlotMachine slots_;
  std::map<PeerKey, List> lists_;
  Origin origin_;  // of the message being handled
};

}  // namespace am
