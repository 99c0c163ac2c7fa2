#pragma once

#include <functional>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "agent_manager/routing/peer.h"
#include "vm_protocol/core/slot_machine.h"

namespace am {

/// Who exists: peers by key and by name, the hub's own machines with their other names, and the
/// names kept for modules of the configuration. Ownership: owns the peers, borrows the machines.
/// Thread: one. Limits: the caller bounds the number of peers.
class Directory {
 public:
  /// Takes the peer, or fails if its name is taken and leaves it. REQUIRES: a new key.
  vm::Result<Peer*> Add(std::unique_ptr<Peer>& peer);
  /// The peer is no longer found; the caller ends what concerns it. Null if it is not there.
  std::unique_ptr<Peer> Remove(PeerKey key);
  /// Errors: kAccess for who may not, kBadValue for what is no name, kBusy if it is taken.
  vm::Result<void> Rename(PeerKey key, const std::string& name);

  Peer* ByKey(PeerKey key);
  const Peer* ByKey(PeerKey key) const;
  Peer* Find(std::string_view name);
  const Peer* Find(std::string_view name) const;
  const std::map<PeerKey, std::unique_ptr<Peer>>& peers() const { return peers_; }
  bool IsPresent(std::string_view name) const { return Find(name) != nullptr; }
  /// One of this hub's own modules: from the configuration, or a client that has become one.
  bool IsModule(std::string_view name) const;
  bool IsGuest(std::string_view name) const;
  /// True once a module has said what it is (or was declared original) and can be spoken to.
  bool IsReady(std::string_view name) const;
  /// A peer that is there and knows tags, so that it may be told what the original does not have.
  bool IsModern(std::string_view name) const {
    const Peer* peer = Find(name);
    return peer != nullptr && peer->dialect == Dialect::kModern;
  }
  std::string NameOf(PeerKey key) const;  ///< empty if it is not there
  /// kHub's is the owner's, that of one who is not there a guest's.
  Role RoleOf(PeerKey key) const;
  std::vector<std::string> Names() const;  ///< of peers, sorted
  /// Those and the hub's own machines: whom a message may be sent to.
  std::vector<std::string> Addressable() const;

  /// `replaceable`: a peer may take its name, and then its place.
  void AddMachine(vm::SlotMachine& machine, std::vector<std::string> aliases, bool replaceable);
  /// Null also while a peer has taken its place.
  vm::SlotMachine* Machine(std::string_view name) const;
  /// Each machine once.
  std::vector<vm::SlotMachine*> Machines() const;

  void Reserve(std::set<std::string> names) { reserved_ = std::move(names); }

 private:
  struct Hash {
    using is_transparent = void;
    std::size_t operator()(std::string_view text) const {
      return std::hash<std::string_view>()(text);
    }
  };
  std::map<PeerKey, std::unique_ptr<Peer>> peers_;
  std::unordered_map<std::string, Peer*, Hash, std::equal_to<>> names_;
  // By every name of theirs.
  std::unordered_map<std::string, vm::SlotMachine*, Hash, std::equal_to<>> machines_;
  std::set<std::string, std::less<>> replaceable_;
  std::set<std::string> reserved_;
};

/// True for a name that shows as what it is: no control, invisible or direction-changing
/// characters.
bool IsPlainName(std::string_view name);

}  // namespace am
