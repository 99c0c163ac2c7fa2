#include "agent_manager/routing/file_guard.h"

#include <utility>

namespace am {

using vm::Command;
using vm::Message;
using vm::Relation;
using vm::Result;

bool FileGuard::MustAsk(const Peer& peer, Role role) const {
  return !access_.AllFiles(role) && !peer.files.slots && peer.dialect == Dialect::kModern &&
         peer.kind == PeerKind::kModule;
}

void FileGuard::AskSlots(Peer& peer, const Ask& ask, std::function<void(Peer& peer)> known) {
  if (peer.files.timer != 0) return;
  const auto learn = [this, key = peer.key,
                      known = std::move(known)](const Result<std::string>& declared) {
    Peer* const module = directory_.ByKey(key);
    if (module == nullptr || module->files.slots) return;
    clock_.Cancel(std::exchange(module->files.timer, 0));
    --count_;
    module->files.slots = declared ? FileSlots(*declared) : FileSlots();
    known(*module);
  };
  ++count_;
  peer.files.timer =
      clock_.After(kDeclareLimit, [learn] { learn(vm::Fail(vm::Errc::kTimeout, "")); });
  ask(peer, vm::Inq("Slots.files"), learn);
}

Result<void> FileGuard::Check(const Peer& peer, const Message& message, Role role) const {
  if (access_.AllFiles(role) || message.command == Command::kRep) return {};
  return CheckFiles(peer, message, role);
}

Result<void> FileGuard::CheckFiles(const Peer& peer, const Message& message, Role role) const {
  static const FileSlots kUndeclared;
  if (message.command == Command::kDef && message.relation == Relation::kAppend) {
    const auto kept = vm::ParseMessage(message.value);
    return kept ? CheckFiles(peer, *kept, role) : Result<void>();
  }
  const bool unseen = message.command == Command::kDo ||
                      (message.command == Command::kDef && message.relation == Relation::kFromFile);
  if (unseen) return access_.CheckUnseenLines(role, peer.name);
  return access_.CheckFiles(role, message, peer.files.slots ? *peer.files.slots : kUndeclared,
                            peer.folder);
}

void FileGuard::Forget(Peer& peer) {
  if (peer.files.timer == 0) return;
  clock_.Cancel(std::exchange(peer.files.timer, 0));
  --count_;
}

}  // namespace am
