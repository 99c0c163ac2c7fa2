#include "agent_manager/routing/directory.h"

#include <algorithm>
#include <array>
#include <utility>

#include "agent_manager/routing/own_names.h"
#include "vm_protocol/core/utf8.h"

namespace am {

using vm::Errc;
using vm::Fail;
using vm::Result;

bool IsPlainName(std::string_view name) {
  // Unicode general categories Cc, Cf, Zl, Zp and the wider blanks, as far as they hide a name or
  // turn its direction (Unicode Technical Report 36, "Unicode Security Considerations").
  static constexpr std::array<std::pair<char32_t, char32_t>, 16> kHidden{{{0x00, 0x20},
                                                                          {0x7F, 0xA0},
                                                                          {0xAD, 0xAD},
                                                                          {0x34F, 0x34F},
                                                                          {0x61C, 0x61C},
                                                                          {0x115F, 0x1160},
                                                                          {0x17B4, 0x17B5},
                                                                          {0x180B, 0x180F},
                                                                          {0x2000, 0x200F},
                                                                          {0x2028, 0x202F},
                                                                          {0x205F, 0x206F},
                                                                          {0x2800, 0x2800},
                                                                          {0x3164, 0x3164},
                                                                          {0xFE00, 0xFEFF},
                                                                          {0xFFA0, 0xFFA0},
                                                                          {0xE0000, 0xE0FFF}}};
  for (std::size_t at = 0; at < name.size();) {
    const auto sign = vm::DecodeUtf8(name, at);
    if (!sign) return false;
    for (const auto& [first, last] : kHidden) {
      if (sign->value >= first && sign->value <= last) return false;
    }
    at += sign->length;
  }
  return true;
}

Result<Peer*> Directory::Add(std::unique_ptr<Peer>& peer) {
  if (names_.contains(peer->name) ||
      (machines_.contains(peer->name) && !replaceable_.contains(peer->name)))
    return Fail(Errc::kBusy, "the name @" + peer->name + " is taken");
  Peer* const added = peer.get();
  peers_.emplace(added->key, std::move(peer));
  names_.emplace(added->name, added);
  return added;
}

std::unique_ptr<Peer> Directory::Remove(PeerKey key) {
  const auto found = peers_.find(key);
  if (found == peers_.end()) return nullptr;
  std::unique_ptr<Peer> peer = std::move(found->second);
  peers_.erase(found);
  names_.erase(peer->name);
  return peer;
}

Result<void> Directory::Rename(PeerKey key, const std::string& name) {
  Peer* const peer = ByKey(key);
  if (peer == nullptr || peer->configured || peer->kind == PeerKind::kConsole ||
      peer->kind == PeerKind::kRemote)
    return Fail(Errc::kAccess, "only a client can take a name");
  if (!vm::IsModuleName(name) || !IsPlainName(name))
    return Fail(Errc::kBadValue,
                "found '" + vm::ShownUtf8(name) +
                    "', expected letters, digits, '_' or '-', none of them hidden");
  if (name == peer->name) return {};
  if (names_.contains(name) || machines_.contains(name) || reserved_.contains(name) ||
      IsReservedName(name))
    return Fail(Errc::kBusy, "the name @" + name + " is taken");
  names_.erase(peer->name);
  names_.emplace(name, peer);
  peer->name = name;
  return {};
}

Peer* Directory::ByKey(PeerKey key) { return const_cast<Peer*>(std::as_const(*this).ByKey(key)); }
const Peer* Directory::ByKey(PeerKey key) const {
  const auto found = peers_.find(key);
  return found == peers_.end() ? nullptr : found->second.get();
}
Peer* Directory::Find(std::string_view name) {
  return const_cast<Peer*>(std::as_const(*this).Find(name));
}
const Peer* Directory::Find(std::string_view name) const {
  const auto found = names_.find(name);
  return found == names_.end() ? nullptr : found->second;
}

bool Directory::IsModule(std::string_view name) const {
  const Peer* const peer = Find(name);
  return peer != nullptr && peer->kind == PeerKind::kModule;
}

bool Directory::IsGuest(std::string_view name) const {
  const Peer* const peer = Find(name);
  return peer != nullptr && peer->role == Role::kGuest;
}

bool Directory::IsReady(std::string_view name) const {
  const Peer* const peer = Find(name);
  return peer != nullptr && !peer->probe.probing;
}

std::string Directory::NameOf(PeerKey key) const {
  const Peer* const peer = ByKey(key);
  return peer == nullptr ? "" : peer->name;
}

Role Directory::RoleOf(PeerKey key) const {
  if (key == kHub) return Role::kOwner;
  const Peer* const peer = ByKey(key);
  return peer == nullptr ? Role::kGuest : peer->role;
}

std::vector<std::string> Directory::Names() const {
  std::vector<std::string> names;
  for (const auto& [name, peer] : names_) names.push_back(name);
  std::ranges::sort(names);
  return names;
}

std::vector<std::string> Directory::Addressable() const {
  std::vector<std::string> names = Names();
  for (const auto& [name, machine] : machines_) names.push_back(name);
  std::ranges::sort(names);
  names.erase(std::ranges::unique(names).begin(), names.end());
  return names;
}

void Directory::AddMachine(vm::SlotMachine& machine, std::vector<std::string> aliases,
                           bool replaceable) {
  if (replaceable) replaceable_.insert(machine.module_name());
  machines_[machine.module_name()] = &machine;
  for (std::string& alias : aliases) machines_[std::move(alias)] = &machine;
}

vm::SlotMachine* Directory::Machine(std::string_view name) const {
  const auto found = machines_.find(name);
  if (found == machines_.end()) return nullptr;
  return replaceable_.contains(name) && names_.contains(name) ? nullptr : found->second;
}

std::vector<vm::SlotMachine*> Directory::Machines() const {
  std::vector<vm::SlotMachine*> machines;
  for (const auto& [name, machine] : machines_) {
    if (std::ranges::find(machines, machine) == machines.end()) machines.push_back(machine);
  }
  return machines;
}

}  // namespace am
