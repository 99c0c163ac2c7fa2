#include "agent_manager/routing/requests.h"

#include <algorithm>
#include <charconv>
#include <utility>

#include "vm_protocol/core/client.h"

namespace am {

using vm::Errc;
using vm::Error;
using vm::Message;

namespace {

/// The hub's own tags are "h" and a number; 0 for a tag that is none of ours.
unsigned long NumberOf(std::string_view tag) {
  unsigned long number = 0;
  if (tag.starts_with('h')) std::from_chars(tag.data() + 1, tag.data() + tag.size(), number);
  return number;
}

}  // namespace

Requests::Requests(vm::Scheduler& clock, Directory& directory, Outbox& outbox, const Limits& limits)
    : clock_(clock), directory_(directory), outbox_(outbox), limits_(limits) {}

void Requests::Fail(const Peer& module, const Request& request, const Error& error) {
  outbox_.Answer(request.asker, module.name, request.message, std::unexpected(error), request.done);
}

Request Requests::TakeOldest(Peer& module) {
  RequestTable& table = module.requests;
  const auto oldest = table.open.begin();
  // What is the oldest of all is the oldest of its slot.
  const auto numbers = table.by_slot.find(oldest->second.message.slot);
  if (numbers != table.by_slot.end() && numbers->second.front() == oldest->first) {
    numbers->second.pop_front();
    if (numbers->second.empty()) table.by_slot.erase(numbers);
  }
  Request request = std::move(oldest->second);
  table.open.erase(oldest);
  return request;
}

unsigned long Requests::Insert(Peer& module, Request request) {
  RequestTable& table = module.requests;
  if (table.open.size() >= limits_.pending)
    Fail(module, TakeOldest(module),
         {Errc::kTimeout, "@" + module.name + " leaves too many requests unanswered", 0});
  request.asked = clock_.Now();
  const unsigned long number = ++last_number_;
  table.open.emplace_hint(table.open.end(), number, std::move(request));
  if (table.timer == 0) Watch(module);
  return number;
}

std::string Requests::Add(Peer& module, Request request) {
  return "h" + std::to_string(Insert(module, std::move(request)));
}

void Requests::AddBySlot(Peer& module, Request request) {
  const std::string slot = request.message.slot;
  const unsigned long number = Insert(module, std::move(request));
  module.requests.by_slot[slot].push_back(number);
}

void Requests::Watch(Peer& module) {
  const vm::Time oldest = module.requests.open.begin()->second.asked;
  module.requests.timer =
      clock_.At(oldest + kAnswerLimit, [this, key = module.key] { Expire(key); });
}

void Requests::Expire(PeerKey key) {
  Peer* const module = directory_.ByKey(key);
  if (module == nullptr) return;
  RequestTable& table = module->requests;
  table.timer = 0;
  while (!table.open.empty() && table.open.begin()->second.asked + kAnswerLimit <= clock_.Now()) {
    Fail(*module, TakeOldest(*module),
         {Errc::kTimeout,
          "@" + module->name + " has not answered for " + vm::FormatMs(kAnswerLimit) + " ms", 0});
  }
  if (!table.open.empty()) Watch(*module);
}

bool Requests::Resolve(Peer& module, const Message& rep) {
  if (rep.tag.empty()) return false;
  RequestTable& table = module.requests;
  const auto found = table.open.find(NumberOf(rep.tag));
  if (found == table.open.end()) return true;  // late, or not ours: nobody waits for it
  const std::string slot = SlotOf(found->second.message);
  const bool refused = rep.slot == slot + ".error" || rep.slot == "Error";
  if (!refused && rep.slot != slot) {  // a member of a group, before the answer itself
    found->second.members_seen = true;
    if (Peer* const asker = directory_.ByKey(found->second.asker)) {
      Message member = rep;
      member.tag = found->second.message.tag;
      member.from = module.name;
      outbox_.Send(*asker, member, kHub);
    }
    return true;
  }
  const Request request = std::move(found->second);
  table.open.erase(found);
  if (table.open.empty()) clock_.Cancel(std::exchange(table.timer, 0));
  // A group has no value of its own; its tagged end is only for those who asked with a tag.
  if (!refused && request.members_seen && request.message.tag.empty() && !request.done) return true;
  outbox_.Answer(request.asker, module.name, request.message,
                 refused ? vm::Result<std::string>(std::unexpected(vm::ParseError(rep.value)))
                         : vm::Result<std::string>(rep.value),
                 request.done);
  return true;
}

std::vector<Request> Requests::TakeBySlot(Peer& module, const std::string& slot) {
  std::vector<Request> requests;
  RequestTable& table = module.requests;
  const auto numbers = table.by_slot.find(slot);
  if (numbers == table.by_slot.end()) return requests;
  for (const unsigned long number : numbers->second) {
    const auto found = table.open.find(number);
    if (found == table.open.end()) continue;
    requests.push_back(std::move(found->second));
    table.open.erase(found);
  }
  table.by_slot.erase(numbers);
  if (table.open.empty()) clock_.Cancel(std::exchange(table.timer, 0));
  return requests;
}

void Requests::FailAll(Peer& module, const Error& error) {
  const auto open = std::move(module.requests.open);
  Forget(module);
  for (const auto& [number, request] : open) Fail(module, request, error);
}

void Requests::Forget(Peer& module) {
  clock_.Cancel(module.requests.timer);
  module.requests = {};
}

}  // namespace am
