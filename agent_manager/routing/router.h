#pragma once

#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "agent_manager/access/rights.h"
#include "agent_manager/routing/module_lines.h"
#include "agent_manager/routing/rules.h"

namespace am {

/// Who gets what: takes one envelope, asks whether it may be said, applies the rules, and hands it
/// to its receivers, or answers why not. Thread: the scheduler's; called by the hub's loop only.
/// All that it is given outlives it.
class Router {
 public:
  Router(vm::Scheduler& clock, SessionLog& log, Directory& directory, Outbox& outbox,
         Requests& requests, ModuleLines& lines, WorkQueue& queue, const AccessControl& access,
         const Limits& limits);

  /// What it needs of the envelope it takes.
  void Route(Envelope& envelope);
  /// What one of the hub's own machines says: to one peer, or to all who subscribed to it.
  void FromMachine(const std::string& machine, PeerKey to, const vm::Message& said);

  Rules& rules() { return rules_; }
  /// Reports (`rep`, `tell`) without receiver also go to peers of these names.
  void set_broadcast(std::set<std::string> names) { broadcast_ = std::move(names); }
  /// Told of every report of a peer, after everybody else.
  using OnReport = std::function<void(const std::string& from, const vm::Message& message)>;
  void set_on_report(OnReport on_report) { on_report_ = std::move(on_report); }
  /// A client has said `rep Run = LIVE`: it is a module.
  void set_on_module(std::function<void(Peer&)> on_module) { on_module_ = std::move(on_module); }
  /// Asked about a receiver that is not there: true if it has been attached meanwhile, false if it
  /// is nobody, an error if there is more to say about it.
  using OnUnknown = std::function<vm::Result<bool>(const std::string& name)>;
  void set_on_unknown(OnUnknown on_unknown) { on_unknown_ = std::move(on_unknown); }
  /// Asked before a message reaches one of the hub's machines: whether it may (else the error is
  /// the answer), and whether it has been dealt with already.
  struct Taken {
    bool taken = false;
    std::optional<std::string> answer{};  ///< to a tagged request, if it is known by now
  };
  using OnMachine =
      std::function<vm::Result<Taken>(vm::SlotMachine& machine, const Envelope& envelope)>;
  void set_on_machine(OnMachine on_machine) { on_machine_ = std::move(on_machine); }

 private:
  void Report(Peer& sender, vm::Message message);
  void ReportByRule(Peer& sender, vm::Message message);
  void ReportNow(Peer& sender, vm::Message message);
  void Deliver(Envelope& envelope, std::string& receiver);
  void DeliverByRule(Envelope& envelope, std::string& receiver);
  void DeliverNow(Envelope& envelope, const std::string& receiver);
  void ToMachine(vm::SlotMachine& machine, Envelope& envelope);
  void CarryOut(const Rules::Outcome& outcome, const std::string& from);
  std::string SenderOf(const Envelope& envelope) const;
  Rules::Sender RuleSenderOf(const Envelope& envelope) const;
  void Refuse(const Envelope& envelope, const vm::Error& error, const std::string& by = "AM");
  vm::Result<void> CountDefinition(const Envelope& envelope);
  void LogTo(const Envelope& envelope, const std::string& receiver);

  vm::Scheduler& clock_;
  SessionLog& log_;
  Directory& directory_;
  Outbox& outbox_;
  Requests& requests_;
  ModuleLines& lines_;
  WorkQueue& queue_;
  const AccessControl& access_;
  const Limits& limits_;
  Rules rules_;
  std::set<std::string> broadcast_;
  OnReport on_report_;
  OnUnknown on_unknown_;
  OnMachine on_machine_;
  std::function<void(Peer&)> on_module_;
  std::map<unsigned long, OnAnswer> asked_of_machines_;  // by our tag's number, the oldest first
  unsigned long last_number_ = 0;
};

}  // namespace am
