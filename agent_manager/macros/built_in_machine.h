#pragma once

#include <string>

#include "agent_manager/routing/envelope.h"
#include "vm_protocol/core/slot_machine.h"

namespace am {

/// A part of the hub that is addressed like a module and has work under way: @AM-MCL, @PAR, @SND.
/// It answers messages to it and hears every report of modules. Thread: the scheduler's.
class BuiltInMachine {
 public:
  virtual ~BuiltInMachine() = default;

  virtual vm::SlotMachine& slots() = 0;
  /// Handles a message addressed to it.
  virtual void Handle(const Envelope& envelope) = 0;
  /// Called for every report and event of a module.
  virtual void OnReport(const std::string& from, const vm::Message& message) = 0;
  /// Called when a module joins (`present`) or leaves the hub; `reason` says why.
  virtual void OnPresence(const std::string& name, bool present, const std::string& reason) = 0;
  /// Answers with `error` every peer that waits for its work to end: the hub stops before that.
  virtual void Abandon(const vm::Error& error) = 0;
  /// True if `peer` waits for some of its work to end.
  virtual bool IsAwaitedBy(PeerKey peer) const = 0;
  /// True while it has work under way.
  virtual bool Busy() const = 0;
};

}  // namespace am
