#include "agent_manager/routing/held_starts.h"

#include "vm_protocol/core/start_time.h"

namespace am {

std::optional<vm::Time> StartTimeOf(const vm::Message& message) {
  if (message.command != vm::Command::kSet || !message.value.starts_with('@')) return std::nullopt;
  const auto start = vm::ParseStartTime(message.value);
  if (!start || start->kind != vm::StartTime::Kind::kAt) return std::nullopt;
  return start->time;
}

bool HeldStarts::Hold(Peer& module, const vm::Message& message) {
  if (message.command != vm::Command::kSet) return false;
  auto& held = module.held_starts;
  if (const auto before = held.find(message.slot); before != held.end()) {
    clock_.Cancel(before->second);
    held.erase(before);
    --count_;
  }
  const auto start = StartTimeOf(message);
  if (!start || held.size() >= limits_.pending) return false;
  ++count_;
  held[message.slot] =
      clock_.At(*start, [this, key = module.key, slot = message.slot] { Start(key, slot); });
  return true;
}

void HeldStarts::Start(PeerKey key, const std::string& slot) {
  Peer* const module = directory_.ByKey(key);
  if (module == nullptr) return;
  module->held_starts.erase(slot);
  --count_;
  send_(*module, vm::Set(slot, "NOW"));
}

void HeldStarts::Forget(Peer& module) {
  for (const auto& [slot, timer] : module.held_starts) clock_.Cancel(timer);
  count_ -= module.held_starts.size();
  module.held_starts.clear();
}

}  // namespace am
