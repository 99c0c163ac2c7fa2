#pragma once

#include <functional>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "agent_manager/access/rights.h"
#include "agent_manager/routing/forwarder.h"
#include "agent_manager/routing/machine_questions.h"
#include "agent_manager/routing/own_names.h"
#include "agent_manager/routing/rules.h"

namespace am {

/// Decides who gets a message: checks the sender's rights, applies the rules, and hands the message
/// to each receiver, or answers the sender with the reason why not. The answer of a module to a
/// tagged request goes to the asker alone; rights and rules do not see it.
/// Thread: the scheduler's; called by the hub's loop only. All that it is given outlives it.
class Router {
 public:
  Router(vm::Scheduler& clock, SessionLog& log, Directory& directory, Outbox& outbox,
         Requests& requests, Forwarder& forwarder, WorkQueue& queue, const AccessControl& access,
         const Limits& limits);

  /// Takes what it needs out of the envelope.
  void Route(Envelope& envelope);
  /// What one of the hub's own machines says: an answer to a peer, or, with kHub, to one of the
  /// hub's parts if it has a tag, else a report to all peers that subscribed to the machine.
  void FromMachine(const std::string& machine, PeerKey to, const vm::Message& said);

  void set_rules(std::vector<Rule> rules) { rules_.set_rules(std::move(rules)); }
  /// All messages that rules delay, in Limits::backlog_bytes; one peer has one of these shares.
  static constexpr std::size_t kDelayShares = 8;
  /// True while messages wait because a rule delays them.
  bool HoldsBack() const { return delayed_ > 0; }
  /// Reports (`rep`, `tell`) without receiver also go to peers of these names.
  void set_broadcast(std::set<std::string> names) { broadcast_ = std::move(names); }
  /// Told of every report of a peer, after everybody else.
  using OnReport = std::function<void(const std::string& from, const vm::Message& message)>;
  void set_on_report(OnReport on_report) { on_report_ = std::move(on_report); }
  /// A client has said `rep Run = LIVE`: it is a module.
  void set_on_module(std::function<void(Peer&)> on_module) { on_module_ = std::move(on_module); }
  /// Asked about a receiver that is not there: true if it has been attached meanwhile, false if it
  /// is nobody, an error if there is more to say about it.
  using OnUnknown = std::function<vm::Result<bool>(const std::string& name, Role asker)>;
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
  void RouteReport(Peer& sender, vm::Message message);
  void ApplyRulesToReport(Peer& sender, vm::Message message);
  void Spread(Peer& sender, vm::Message message);
  std::set<PeerKey> HearersOf(const Peer& sender);
  void RouteTo(std::string& receiver, Envelope& envelope);
  void ApplyRules(Envelope& envelope, std::string& receiver);
  void HandOver(Envelope& envelope, const std::string& receiver);
  void ToMachine(vm::SlotMachine& machine, Envelope& envelope);
  void ReportOf(const std::string& machine, vm::Message message);
  void SendCopies(const Rules::Outcome& outcome, const std::string& from, Role role);
  /// Does it later, in the loop. `sender`: the peer whose message it is, and whose error if it
  /// throws; `bytes`: of the message. kLimit if too much is delayed already.
  vm::Result<void> Delay(vm::Time delay, std::function<void()> act, PeerKey sender,
                         std::size_t bytes);
  std::string SenderOf(const Envelope& envelope) const;
  Rules::Sender RuleSenderOf(const Envelope& envelope) const;
  void Refuse(const Envelope& envelope, const vm::Error& error,
              const std::string& by = own_name::kHub);
  vm::Result<void> CountDefinition(const Envelope& envelope);
  void LogTo(const Envelope& envelope, const std::string& receiver);

  vm::Scheduler& clock_;
  SessionLog& log_;
  Directory& directory_;
  Outbox& outbox_;
  Requests& requests_;
  Forwarder& forwarder_;
  WorkQueue& queue_;
  const AccessControl& access_;
  const Limits& limits_;
  Rules rules_;
  std::set<std::string> broadcast_;
  OnReport on_report_;
  OnUnknown on_unknown_;
  OnMachine on_machine_;
  std::function<void(Peer&)> on_module_;
  MachineQuestions questions_;
  std::size_t delayed_ = 0;        // messages
  std::size_t delayed_bytes_ = 0;  // of all peers
};

}  // namespace am
