#include "agent_manager/session/replay.h"

#include <sstream>
#include <stdexcept>
#include <utility>

#include "agent_manager/log/log_writer.h"
#include "agent_manager/routing/own_names.h"

namespace am {

Replay::Replay(vm::Scheduler& clock, Hub& hub, const std::string& path,
               std::set<std::string> modules, double speed)
    : clock_(clock), hub_(hub), speed_(speed) {
  modules.insert({own_name::kHub, own_name::kMacros, own_name::kMacrosOfTheOriginal,
                  own_name::kParallel, own_name::kSound});
  std::istringstream text(ReadLog(path));
  std::size_t number = 0;
  for (std::string line; std::getline(text, line);) {
    ++number;
    const auto entry = ParseLogEntry(line);
    if (!entry && entry.error().code == vm::Errc::kEmpty) continue;
    if (!entry)
      throw std::runtime_error(path + " line " + std::to_string(number) + ": " +
                               entry.error().text);
    const auto message = vm::ParseMessage(entry->line);
    // What people and clients said is said again. What modules answered then, they answer now, and
    // `do FILE`, which is said again, says the lines of the file.
    const bool about_the_client = message && (message->slot == "Wait" || message->slot == "Name" ||
                                              message->slot == "Subscribe");
    if (message && !modules.contains(entry->sender) && !entry->IsOfScript() &&
        message->command != vm::Command::kRep && !about_the_client)
      entries_.push_back(*entry);
  }
  pending_ = entries_.size();
}

void Replay::Start(std::function<void()> on_said) {
  if (entries_.empty()) return;
  class Nowhere final : public Link {  // what is answered is in the session's log
    void Send(const Outgoing&) override {}
    void Close() override {}
  };
  const auto key = hub_.Attach(std::make_unique<Nowhere>(), PeerKind::kClient, Role::kOwner,
                               own_name::kReplay, Dialect::kAuto);
  if (!key) throw std::runtime_error("replay: " + key.error().text);
  const vm::Time first = entries_.front().time;
  for (const LogEntry& entry : entries_) {
    const auto offset = std::chrono::duration_cast<vm::Time>((entry.time - first) / speed_);
    clock_.After(offset, [this, peer = *key, line = entry.line, on_said] {
      --pending_;
      on_said();
      hub_.Receive(peer, std::string_view(line));
    });
  }
}

}  // namespace am
