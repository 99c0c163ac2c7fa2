#pragma once

#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "agent_manager/config.h"
#include "agent_manager/limits.h"
#include "agent_manager/rules.h"
#include "agent_manager/session_log.h"
#include "vm_protocol/core/message.h"
#include "vm_protocol/core/scheduler.h"
#include "vm_protocol/core/slot_machine.h"

namespace am {

/// What carries lines to one peer. The hub owns it while the peer is attached.
class Link {
 public:
  virtual ~Link() = default;
  virtual void Send(std::string_view line) = 0;
  virtual void Close() = 0;
  /// Stops and resumes the lines that come from it.
  virtual void PauseReading() {}
  virtual void ResumeReading() {}
  /// What was sent and has not been taken yet.
  virtual std::size_t backlog_bytes() const { return 0; }
};

/// Identifies a peer for its lifetime; never used again. 0 is the hub itself.
using PeerKey = vm::PeerId;

enum class PeerKind {
  kConsole,  ///< the hub's own terminal or input
  kModule,   ///< from the configuration: probed, its clock measured
  kClient,   ///< came by a socket; becomes a module-like name by `to @AM set Name = X`
  kRemote,   ///< a module of another hub, which answers for it: never probed
};

/// What there is to know about a peer that is there.
struct PeerStatus {
  std::string name;
  PeerKind kind = PeerKind::kClient;
  Traffic traffic;
  std::size_t backlog_bytes = 0;
  std::size_t pending = 0;  ///< requests it has not answered
  std::size_t defined = 0;  ///< slots and macros it has made at the hub
  bool held = false;        ///< it is not read from at the moment
};

/// The direct layer (DCL): who is there, and who gets what. Pure: lines come in by OnLine and go
/// out by links; time comes from the scheduler. Ownership: owns the links. Thread: the scheduler's.
/// Limits: struct Limits; they can change at any time.
/// Errors: whatever cannot be delivered is answered to its sender (docs/protocol.md "Errors").
class Hub {
 public:
  Hub(vm::Scheduler& clock, SessionLog& log);
  ~Hub();
  Hub(const Hub&) = delete;

  /// Fails if the name is taken or the hub is full; the link is then closed.
  vm::Result<PeerKey> Attach(std::unique_ptr<Link> link, PeerKind kind, const std::string& name,
                             Dialect dialect);
  void OnLine(PeerKey peer, vm::Result<std::string_view> line);
  /// The peer is gone: pending requests to it are answered with UNAVAILABLE and `reason`.
  void Detach(PeerKey peer, const std::string& reason);

  /// A machine inside the hub that is addressed like a module. Borrowed; outlives the hub's use.
  void AddInternal(vm::SlotMachine& machine, std::vector<std::string> aliases = {});
  /// Sends as the internal machine `sender`; `done` gets the answer (for commands).
  using OnAnswer = std::function<void(vm::Result<std::string>)>;
  void Ask(const std::string& sender, vm::Message message, const OnAnswer& done);

  bool IsPresent(std::string_view name) const;
  /// One of this hub's own modules: from the configuration, or a client that has become one.
  bool IsModule(std::string_view name) const;
  /// True once a module has said what it is (or was declared original) and can be spoken to.
  bool IsReady(std::string_view name) const;
  std::vector<std::string> Names() const;
  std::string NameOf(PeerKey peer) const;
  vm::Result<void> Rename(PeerKey peer, const std::string& name);
  /// Names of the configuration: kept for their modules, also while those are away.
  void Reserve(std::set<std::string> names) { reserved_ = std::move(names); }
  void Subscribe(PeerKey peer, const std::set<std::string>& modules);  ///< "*" = all

  /// Reports (`rep`, `tell`) without receiver also go to peers of these names.
  void set_broadcast(std::set<std::string> names) { broadcast_ = std::move(names); }
  /// Told of every report a module makes, and of comings and goings.
  using OnReport = std::function<void(const std::string& from, const vm::Message& message)>;
  void set_on_report(OnReport on_report) { on_report_ = std::move(on_report); }
  using OnPresence =
      std::function<void(const std::string& name, bool present, const std::string& reason)>;
  void set_on_presence(OnPresence on_presence) { on_presence_ = std::move(on_presence); }
  /// Diagnostics for people.
  using OnNotice = std::function<void(const std::string& text)>;
  void set_on_notice(OnNotice on_notice) { on_notice_ = std::move(on_notice); }

  /// Asked about a receiver that is not there: true if it has been attached meanwhile, false if it
  /// is nobody, an error if there is more to say about it.
  using OnUnknown = std::function<vm::Result<bool>(const std::string& name)>;
  void set_on_unknown(OnUnknown on_unknown) { on_unknown_ = std::move(on_unknown); }

  /// For what is no message of the session and stands in no log; false if the peer is gone.
  bool SendUnlogged(PeerKey peer, std::string_view line);

  /// What happens to messages on their way (hub_rules.cc).
  Rules& rules() { return rules_; }

  // Limits (hub_limits.cc).
  Limits& limits() { return limits_; }
  std::vector<PeerStatus> Status() const;
  /// Told of a peer the hub cuts off, before it is detached.
  using OnCutOff = std::function<void(PeerKey peer, const std::string& why)>;
  void set_on_cut_off(OnCutOff on_cut_off) { on_cut_off_ = std::move(on_cut_off); }

  // Clocks.
  struct ClockState {
    bool known = false;
    vm::Time offset{0};  ///< the peer's clock minus ours
    vm::Time delay{0};   ///< there and back, of the best exchange
  };
  ClockState ClockOf(std::string_view name) const;
  /// Asks every modern module for its clock again (real clock only).
  void MeasureClocks();
  /// Modules on the virtual clock follow ours exactly; nothing is measured.
  void set_lockstep(bool lockstep) { lockstep_ = lockstep; }
  /// Modules that are still being asked what they are.
  std::set<PeerKey> Probing() const;
  /// Those among `modules` that have not answered by now count as original; one that has said
  /// nothing at all is given four times as long.
  void EndProbes(const std::set<PeerKey>& modules);

  /// For the lockstep driver: modules with a clock, and a raw exchange with one.
  std::vector<PeerKey> ModernModules() const;
  void AskClock(PeerKey module, vm::Time grant, OnAnswer done);
  /// Modules something was sent to since their last clock answer.
  std::set<PeerKey>& dirty() { return dirty_; }
  bool HasHeld() const { return held_ > 0; }

 private:
  struct Peer;
  struct Pending;
  void Route(Peer& sender, vm::Message message);
  void Deliver(const std::string& sender_name, PeerKey asker, const std::string& receiver,
               const vm::Message& message, OnAnswer done);
  /// After the rules.
  void DeliverNow(const std::string& sender_name, PeerKey asker, const std::string& receiver,
                  const vm::Message& message, OnAnswer done);
  void DeliverByRule(const std::string& sender_name, PeerKey asker, const std::string& receiver,
                     const vm::Message& message, OnAnswer done);
  void ReportByRule(Peer& sender, vm::Message message);
  void ReportNow(Peer& sender, vm::Message message);
  void CarryOut(const std::string& from, const Rules::Outcome& outcome);
  void Forward(Peer& module, vm::Message message, PeerKey asker, OnAnswer done);
  void GiveUp(PeerKey module, unsigned long number);
  void SendBare(Peer& module, vm::Message message, const std::string& tag);
  bool HoldStart(Peer& module, vm::Message& message);
  bool AwaitClock(Peer& module, const vm::Message& message);
  void ForwardOriginal(Peer& module, vm::Message message, PeerKey asker, const OnAnswer& done);
  void Report(Peer& sender, vm::Message message);
  bool ResolvePending(Peer& sender, const vm::Message& message);
  void AnswerTo(PeerKey asker, const std::string& from, const vm::Message& request,
                const vm::Result<std::string>& result, const OnAnswer& done);
  void Send(Peer& peer, const vm::Message& message);
  /// One line in the log, however many receive it.
  void SendAll(const std::set<PeerKey>& receivers, const vm::Message& message);
  void Write(Peer& peer, std::string_view line);
  void OnBacklog(Peer& peer, std::size_t backlog);
  void WatchBacklog(Peer& peer);
  void ReleaseHeld(Peer& peer);
  void CutOff(Peer& peer, const std::string& why);
  void Throttle(Peer& peer, std::size_t bytes);
  vm::Result<void> CountDefinition(PeerKey peer, const vm::Message& message);
  void Probe(Peer& peer);
  void MeasureClock(Peer& peer, int exchanges);
  void BecomeModern(Peer& peer, vm::Time asked_at, const vm::Result<std::string>& clock);
  void SampleClock(Peer& peer, vm::Time asked_at, const std::string& value);
  void FlushWaiting(Peer& peer);
  Peer* Find(std::string_view name);
  const Peer* Find(std::string_view name) const;
  Peer* ByKey(PeerKey key);
  void Notice(const std::string& text) const;
  void Complain(Peer& sender, const vm::Error& error);

  vm::Scheduler& clock_;
  SessionLog& log_;
  std::map<PeerKey, std::unique_ptr<Peer>> peers_;
  std::map<std::string, PeerKey, std::less<>> names_;
  std::map<std::string, vm::SlotMachine*, std::less<>> internal_;
  std::map<std::string, std::pair<PeerKey, OnAnswer>>
      internal_pending_;  // our tag towards an internal machine
  std::set<std::string> broadcast_;
  std::set<std::string> reserved_;
  std::set<PeerKey> dirty_;
  Limits limits_;
  Rules rules_;
  PeerKey speaking_ = 0;     // whose line is being dealt with
  bool commanding_ = false;  // and it is a command
  OnCutOff on_cut_off_;
  OnReport on_report_;
  OnPresence on_presence_;
  OnUnknown on_unknown_;
  OnNotice on_notice_;
  PeerKey last_key_ = 0;
  unsigned long last_tag_ = 0;
  int held_ = 0;
  unsigned measurements_ = 0;
  bool lockstep_ = false;
};

}  // namespace am
