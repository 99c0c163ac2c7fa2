#pragma once

#include <string>

#include "agent_manager/routing/envelope.h"
#include "vm_protocol/core/slot_machine.h"

namespace am {

/// A machine inside the hub that deals with its messages itself and listens to what modules say:
/// @AM-MCL, @PAR, @SND. Thread: the scheduler's.
class BuiltInModule {
 public:
  virtual ~BuiltInModule() = default;

  virtual vm::SlotMachine& slots() = 0;
  /// Deals with a message to it.
  virtual void Handle(const Envelope& envelope) = 0;
  /// Told of every report and event of the modules.
  virtual void OnReport(const std::string& from, const vm::Message& message) = 0;
  /// Told of modules that come (`present`) and go, and why.
  virtual void OnPresence(const std::string& name, bool present, const std::string& reason) = 0;
  /// Answers whoever waits for something to end, which will not be.
  virtual void Abandon(const vm::Error& error) = 0;
  /// True if `peer` waits for something to end.
  virtual bool IsAwaitedBy(PeerKey peer) const = 0;
  /// True while it does something that has an end.
  virtual bool Busy() const = 0;
};

}  // namespace am
