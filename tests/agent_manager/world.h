#pragma once

#include <algorithm>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "agent_manager/hub.h"
#include "vm_protocol/core/message.h"
#include "vm_protocol/core/scheduler.h"

namespace am {

/// Peers in memory: what each is sent, and what it does about it.
struct World {
  struct Peer {
    PeerKey key = 0;
    std::vector<std::string> heard;
    std::function<void(const std::string& line)> on_line;
    bool closed = false;
  };
  class MemoryLink final : public Link {
   public:
    MemoryLink(World& world, std::shared_ptr<Peer> peer) : world_(world), peer_(std::move(peer)) {}
    void Send(std::string_view line) override {
      peer_->heard.emplace_back(line);
      // As on a pipe: the other side reacts later, never within our call.
      if (peer_->on_line)
        world_.clock.Post([peer = peer_, text = std::string(line)] { peer->on_line(text); });
    }
    void Close() override { peer_->closed = true; }

   private:
    World& world_;
    std::shared_ptr<Peer> peer_;
  };

  std::shared_ptr<Peer> Join(PeerKind kind, const std::string& name,
                             Dialect dialect = Dialect::kAuto,
                             std::function<void(const std::string&)> on_line = nullptr) {
    auto peer = std::make_shared<Peer>();
    peer->on_line = std::move(on_line);
    peer->key =
        hub.Attach(std::make_unique<MemoryLink>(*this, peer), kind, name, dialect).value_or(0);
    return peer;
  }
  void Say(const Peer& peer, const std::string& line) {
    hub.OnLine(peer.key, std::string_view(line));
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
        if (answers)
          hub.OnLine(self->key,
                     vm::Result<std::string_view>(std::string_view(vm::FormatMessage(rep))));
      }
      if (also) also(*self, *message);
    };
    peer->key = hub.Attach(std::make_unique<MemoryLink>(*this, peer), PeerKind::kModule, name,
                           Dialect::kAuto)
                    .value_or(0);
    clock.RunReady();
    return peer;
  }
  static bool Heard(const Peer& peer, const std::string& line) {
    return std::ranges::count(peer.heard, line) == 1;
  }

  vm::VirtualScheduler clock;
  SessionLog log;
  Hub hub{clock, log};
  bool answers = true;
};

}  // namespace am
