#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "agent_manager/routing/module_clocks.h"
#include "agent_manager/routing/router.h"

namespace am {

/// The direct layer (DCL): who is there, and who gets what. Whatever is said, by a peer or by one
/// of the hub's own parts, waits in one queue; Drain, called by the program's loop and by nobody
/// else, takes one item after the other, so no consumer runs in the middle of another, and a peer
/// goes only between two items. What an item throws is that peer's error. Pure: lines come in by
/// Receive and go out by links; time comes from the scheduler. Ownership: owns the links. Thread:
/// the scheduler's. Limits: struct Limits; they can change at any time. Errors: whatever cannot be
/// delivered is answered to its sender (docs/protocol.md "Errors").
class Hub {
 public:
  Hub(vm::Scheduler& clock, SessionLog& log);
  ~Hub();
  Hub(const Hub&) = delete;

  /// Fails if the name is taken or the hub is full; the link is then closed.
  vm::Result<PeerKey> Attach(std::unique_ptr<Link> link, PeerKind kind, Role role,
                             const std::string& name, Dialect dialect);
  /// A module of the configuration, whose name is its own, and which runs in `folder`.
  vm::Result<PeerKey> AttachModule(std::unique_ptr<Link> link, const std::string& name,
                                   Dialect dialect, const std::string& folder);
  /// What a peer has said.
  void Receive(PeerKey peer, vm::Result<std::string_view> line);
  void Receive(PeerKey peer, vm::Message message);
  /// The peer goes, after what it has said before: pending requests to it are answered with
  /// UNAVAILABLE and `reason`.
  void Leave(PeerKey peer, const std::string& reason);
  /// The peer has said all it will say; it leaves when its questions have been answered.
  void EndInput(PeerKey peer);
  /// Answers every open request with the error: the hub ends before its peers can.
  void FailRequests(const vm::Error& error);
  /// Calls `done` once every peer's system has taken what the peer was sent, or while the hub is
  /// taken apart: it may outlive its caller.
  void WhenAllSent(std::function<void()> done);
  /// As Leave, at once. REQUIRES: no message is being dealt with (use Post).
  void Evict(PeerKey peer, const std::string& reason);

  /// Deals with what has been said by now. False if there was nothing to do.
  bool Drain();
  bool idle() const { return queue_.empty(); }
  /// Does something in the loop, between two messages, after what `cause` has said before.
  void Post(std::function<void()> act, PeerKey cause = kHub) { queue_.Post(std::move(act), cause); }

  /// A machine inside the hub that is addressed like a module. Borrowed; outlives the hub's use.
  /// `replaceable`: a module of that name may take its place.
  void AddMachine(vm::SlotMachine& machine, std::vector<std::string> aliases = {},
                  bool replaceable = false);
  /// Says something as the hub's own machine `sender`, on behalf of `origin`; `done` is called from
  /// the queue with the answer.
  void Ask(const std::string& sender, vm::Message message, OnAnswer done,
           const Origin& origin = Origin::OfHub());
  /// Says something as a peer, as if it had come by its link: the lines of `do`.
  void SayAs(const Origin& origin, vm::Message message);
  /// kLimit if more than `most_items` messages, or WorkQueue::kMaxCausedBytes, that Ask and SayAs
  /// were given for this origin have not been dealt with.
  vm::Result<void> CheckCaused(const Origin& origin, std::size_t most_items) const;

  /// Asked whether a peer still waits for an answer of one of the hub's own parts.
  void set_awaited_by(std::function<bool(PeerKey peer)> awaited_by) {
    awaited_by_ = std::move(awaited_by);
  }

  /// Who is there.
  const Directory& directory() const { return directory_; }
  vm::Result<void> Rename(PeerKey peer, const std::string& name);
  /// Names of the configuration: kept for their modules, also while those are away.
  /// A client that has one of them gets another name.
  void Reserve(const std::set<std::string>& names);
  void Subscribe(PeerKey peer, const std::set<std::string>& modules);  ///< "*" = all
  /// True if a peer has subscribed to this name; "*" does not count.
  bool HasSubscriber(std::string_view module) const { return subscribers_.contains(module); }
  std::vector<PeerStatus> Status() const;

  /// For its settings.
  Router& router() { return router_; }
  /// Told of comings and goings.
  using OnPresence =
      std::function<void(const std::string& name, bool present, const std::string& reason)>;
  void set_on_presence(OnPresence on_presence) { on_presence_ = std::move(on_presence); }
  /// Diagnostics for people.
  void set_on_notice(Outbox::OnNotice on_notice) { outbox_.set_on_notice(std::move(on_notice)); }

  /// A comment, for what is no message of the session; false if the peer is gone.
  bool SendComment(PeerKey peer, std::string_view text);

  void set_rights(RightsTable rights) { access_.set_table(std::move(rights)); }
  const AccessControl& access() const { return access_; }
  void set_limits(const Limits& limits) { limits_ = limits; }
  void set_limit(std::uint64_t Limits::*member, std::uint64_t value) { limits_.*member = value; }
  const Limits& limits() const { return limits_; }

  /// What is known of the modules' clocks.
  ModuleClocks& clocks() { return clocks_; }
  const ModuleClocks& clocks() const { return clocks_; }

  /// Modules on the virtual clock follow ours exactly; nothing is measured.
  void set_lockstep(bool lockstep);
  /// As ClockGrants::Grant.
  void Grant(PeerKey module, vm::Time until, OnAnswer done);
  /// As ClockGrants::AnyOutdated.
  bool AnyGrantOutdated() const { return grants_.AnyOutdated(); }
  /// True while messages wait for their time.
  bool HoldsBack() const { return router_.HoldsBack() || forwarder_.HoldsBack(); }

 private:
  void HoldWhileInLane(PeerKey peer, bool begins);
  vm::Result<PeerKey> Add(std::unique_ptr<Peer> peer);
  /// Counts what a peer has sent. Null if the peer is gone or is being cut off.
  Peer* CountInput(PeerKey peer, std::size_t bytes);
  void Take(Peer& sender, vm::Message message, std::size_t bytes);
  void DealWith(WorkQueue::Item& item);
  void ReleaseHalfClosed();
  void CountSubscriptions(const Peer& peer, int sign);
  std::string FreeName();
  void AnnounceRename(const std::string& before, const std::string& name);
  std::uint64_t GuestsThere() const;
  /// Who waits for the answer to a message, and what it has to name.
  struct Asked {
    PeerKey asker = kHub;
    vm::Message request;  ///< without its value
    OnAnswer done;
  };
  /// Null if nobody waits for an answer. `done` of both may be called: the first call counts.
  static std::optional<Asked> AskedBy(Envelope& envelope);
  /// What dealing with an item has thrown is the error of the peer that caused it, and the answer
  /// to what was asked.
  void ReportFailure(PeerKey peer, const std::string& what, const std::optional<Asked>& asked);

  vm::Scheduler& clock_;
  Limits limits_;
  AccessControl access_;
  WorkQueue queue_;
  Directory directory_;
  BackPressure back_pressure_;
  Outbox outbox_;
  Requests requests_;
  ClockGrants grants_;
  Forwarder forwarder_;
  ModuleClocks clocks_;
  Router router_;
  std::map<PeerKey, vm::TimerId> half_closed_;  // and what ends their waiting
  std::function<bool(PeerKey)> awaited_by_;
  OnPresence on_presence_;
  std::map<std::string, std::size_t, std::less<>> subscribers_;  // how many, by name
  PeerKey last_key_ = 0;
  unsigned long last_name_ = 0;  // of those who have none
};

}  // namespace am
