#pragma once

#include <algorithm>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "agent_manager/macros/built_in_machine.h"
#include "agent_manager/routing/hub.h"
#include "vm_protocol/core/message.h"
#include "vm_protocol/core/scheduler.h"

namespace am {

/// A virtual clock that has the hub's queue worked off before time goes on, as the program's loop
/// does.
class LoopClock final : public vm::Scheduler {
 public:
  vm::Time Now() const override { return inner_.Now(); }
  vm::TimerId At(vm::Time when, std::function<void()> action) override {
    return inner_.At(when, std::move(action));
  }
  void Cancel(vm::TimerId id) override { inner_.Cancel(id); }

  void set_hub(Hub& hub) { hub_ = &hub; }
  /// Deals with all that has been said, and what is due at this instant. Within itself: later.
  void Settle() {
    if (std::exchange(settling_, true)) return;
    for (int rounds = 0; rounds < kMaxRounds && hub_->Drain(); ++rounds) {
    }
    settling_ = false;
  }
  void RunReady() { RunUntil(inner_.Now()); }
  void RunUntil(vm::Time until) {
    Settle();
    while (inner_.Next() && *inner_.Next() <= until) {
      inner_.RunUntil(*inner_.Next());
      Settle();
    }
    inner_.RunUntil(until);
  }
  bool RunUntilIdle(vm::Time limit) {
    Settle();
    while (inner_.Next() && *inner_.Next() <= limit) RunUntil(*inner_.Next());
    return !inner_.Next();
  }

 private:
  static constexpr int kMaxRounds = 100000;
  vm::VirtualScheduler inner_;
  Hub* hub_ = nullptr;
  bool settling_ = false;
};

/// Peers in memory: what each is sent, and what it does about it.
struct World {
  World() { clock.set_hub(hub); }

  struct Peer {
    PeerKey key = 0;
    std::vector<std::string> heard;
    std::function<void(const std::string& line)> on_line;
    bool closed = false;
    bool paused = false;
    std::size_t backlog = 0;  ///< what it has not read, as its link says
  };
  class MemoryLink final : public Link {
   public:
    MemoryLink(World& world, std::shared_ptr<Peer> peer) : world_(world), peer_(std::move(peer)) {}
    void Send(const Outgoing& outgoing) override {
      peer_->heard.push_back(outgoing.line());
      // As on a pipe: the other side reacts later, never within our call.
      if (peer_->on_line)
        world_.clock.Post([peer = peer_, text = outgoing.line()] { peer->on_line(text); });
    }
    void SendComment(std::string_view text) override { peer_->heard.emplace_back(text); }
    void Close() override { peer_->closed = true; }
    void PauseReading() override { peer_->paused = true; }
    void ResumeReading() override { peer_->paused = false; }
    std::size_t backlog_bytes() const override { return peer_->backlog; }

   private:
    World& world_;
    std::shared_ptr<Peer> peer_;
  };

  std::shared_ptr<Peer> Join(PeerKind kind, const std::string& name,
                             Dialect dialect = Dialect::kAuto,
                             std::function<void(const std::string&)> on_line = nullptr,
                             Role role = Role::kOwner) {
    auto peer = std::make_shared<Peer>();
    peer->on_line = std::move(on_line);
    peer->key = hub.Attach(std::make_unique<MemoryLink>(*this, peer), kind, role, name, dialect)
                    .value_or(0);
    clock.Settle();
    return peer;
  }
  void Say(const Peer& peer, const std::string& line) {
    hub.Receive(peer.key, std::string_view(line));
    clock.Settle();
  }
  /// A guest, or whatever else may do less than the owner.
  std::shared_ptr<Peer> JoinAs(Role role, const std::string& name) {
    return Join(PeerKind::kClient, name, Dialect::kAuto, nullptr, role);
  }
  void Leave(const Peer& peer, const std::string& reason) {
    hub.Leave(peer.key, reason);
    clock.Settle();
  }
  /// A module that answers every tagged request with its value, its clock being ours plus `offset`.
  std::shared_ptr<Peer> JoinModern(const std::string& name, vm::Time offset = vm::Time(0),
                                   std::function<void(Peer&, const vm::Message&)> also = nullptr) {
    auto peer = std::make_shared<Peer>();
    peer->on_line = [this, offset, also,
                     weak = std::weak_ptr<Peer>(peer)](const std::string& line) {
      const auto self = weak.lock();
      const auto message = vm::ParseMessage(line);
      if (!self || !message) return;
      if (!message->tag.empty() && message->command != vm::Command::kRep) {
        vm::Message rep =
            vm::Rep(message->slot,
                    message->slot == "Clock" ? vm::FormatMs(clock.Now() + offset) : message->value);
        rep.tag = message->tag;
        if (answers) hub.Receive(self->key, std::move(rep));
      }
      if (also) also(*self, *message);
    };
    peer->key = hub.Attach(std::make_unique<MemoryLink>(*this, peer), PeerKind::kModule,
                           Role::kModule, name, Dialect::kAuto)
                    .value_or(0);
    clock.RunReady();
    return peer;
  }
  static bool Heard(const Peer& peer, const std::string& line) {
    return std::ranges::count(peer.heard, line) == 1;
  }

  /// One of the hub's own machines deals with its messages and hears what modules say.
  void Connect(BuiltInMachine& machine, std::vector<std::string> aliases = {},
               bool replaceable = false) {
    hub.AddMachine(machine.slots(), std::move(aliases), replaceable);
    hub.router().set_on_machine([&machine](vm::SlotMachine&, const Envelope& envelope) {
      machine.Handle(envelope);
      return vm::Result<Router::Taken>(Router::Taken{.taken = true});
    });
    hub.router().set_on_report([&machine](const std::string& from, const vm::Message& message) {
      machine.OnReport(from, message);
    });
    hub.set_on_presence(
        [&machine](const std::string& name, bool present, const std::string& reason) {
          machine.OnPresence(name, present, reason);
        });
  }

  LoopClock clock;
  SessionLog log;
  Hub hub{clock, log};
  bool answers = true;
};

}  // namespace am
