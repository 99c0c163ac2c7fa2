#include "agent_manager/routing/requests.h"

#include <algorithm>
#include <utility>

#include "agent_manager/routing/tag.h"
#include "vm_protocol/core/client.h"

namespace am {

using vm::Errc;
using vm::Error;
using vm::Message;

namespace {

constexpr char kTagLetter = 'h';

}  // namespace

Requests::Requests(vm::Scheduler& clock, Directory& directory, Outbox& outbox,
                   BackPressure& back_pressure, const Limits& limits)
    : clock_(clock),
      directory_(directory),
      outbox_(outbox),
      back_pressure_(back_pressure),
      limits_(limits) {}

void Requests::Fail(const Peer& module, const Request& request, const Error& error) {
  outbox_.Answer(request.asker, module.name, request.message, std::unexpected(error), request.done);
}

/// REQUIRES: the request is open.
Request Requests::Take(Peer& module, unsigned long number) {
  RequestTable& table = module.requests;
  const auto found = table.open.find(number);
  Request request = std::move(found->second);
  table.open.erase(found);
  if (const auto slot = table.by_slot.find(request.message.slot); slot != table.by_slot.end()) {
    slot->second.erase(number);
    if (slot->second.empty()) table.by_slot.erase(slot);
  }
  if (const auto mine = table.by_asker.find(request.asker); mine != table.by_asker.end()) {
    mine->second.erase(number);
    if (mine->second.empty()) table.by_asker.erase(mine);
  }
  if (table.open.empty()) clock_.Cancel(std::exchange(table.timer, 0));
  UncountUnanswered(request.asker);
  return request;
}

void Requests::CountUnanswered(PeerKey asker) {
  Peer* const peer = directory_.ByKey(asker);
  if (peer == nullptr || ++peer->asked.open <= limits_.pending / 2 || peer->asked.holds) return;
  if (!peer->requests.open.empty()) return;  // others wait for what it says
  peer->asked.holds = back_pressure_.Hold(*peer);
}

void Requests::UncountUnanswered(PeerKey asker) {
  Peer* const peer = directory_.ByKey(asker);
  if (peer == nullptr) return;
  --peer->asked.open;
  if (peer->asked.open <= limits_.pending / 4) GoOnReading(*peer);
}

void Requests::GoOnReading(Peer& peer) {
  if (std::exchange(peer.asked.holds, false)) BackPressure::LetGo(peer);
}

void Requests::Refuse(Peer& module, PeerKey asker) {
  const Request request = Take(module, *module.requests.by_asker.at(asker).begin());
  Fail(module, request,
       {Errc::kLimit, "too many requests to @" + module.name + " are unanswered", 0});
}

unsigned long Requests::Insert(Peer& module, Request request) {
  RequestTable& table = module.requests;
  const PeerKey asker = request.asker;
  if (const auto mine = table.by_asker.find(asker);
      mine != table.by_asker.end() && asker != kHub && mine->second.size() >= limits_.pending) {
    Refuse(module, asker);
  } else if (table.open.size() >= limits_.pending * kPeersShares) {
    const auto most = std::ranges::max_element(
        table.by_asker, {}, [](const auto& entry) { return entry.second.size(); });
    Refuse(module, most->first);
  }
  GoOnReading(module);  // its answer is wanted
  request.asked = clock_.Now();
  const unsigned long number = ++last_number_;
  table.open.emplace_hint(table.open.end(), number, std::move(request));
  table.by_asker[asker].insert(number);
  if (table.timer == 0) Watch(module);
  CountUnanswered(asker);
  return number;
}

std::string Requests::Add(Peer& module, Request request) {
  return FormatTag(kTagLetter, Insert(module, std::move(request)));
}

void Requests::AddBySlot(Peer& module, Request request) {
  const std::string slot = request.message.slot;
  const unsigned long number = Insert(module, std::move(request));
  module.requests.by_slot[slot].insert(number);
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
    Fail(*module, Take(*module, table.open.begin()->first),
         {Errc::kTimeout,
          "@" + module->name + " has not answered for " + vm::FormatMs(kAnswerLimit) + " ms", 0});
  }
  if (!table.open.empty() && table.timer == 0) Watch(*module);
}

bool Requests::Resolve(Peer& module, const Message& rep) {
  if (rep.tag.empty()) return false;
  RequestTable& table = module.requests;
  const auto found = table.open.find(NumberOfTag(kTagLetter, rep.tag));
  if (found == table.open.end()) return true;  // late, or not ours: nobody waits for it
  const std::string slot = SlotOf(found->second.message);
  const bool refused = rep.slot == slot + ".error" || (rep.slot == "Error" && slot != "Error");
  if (!refused && rep.slot != slot) {  // a member of a group, before the answer itself
    found->second.members_seen = true;
    if (Peer* const asker = directory_.ByKey(found->second.asker)) {
      Message member = rep;
      member.tag = found->second.message.tag;
      member.from = module.name;
      outbox_.Send(*asker, member, WaitsForHearers(module));
    }
    return true;
  }
  const Request request = Take(module, found->first);
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
  // Out of the table first: Take would look each up in it.
  const auto numbers = table.by_slot.extract(slot);
  if (!numbers) return requests;
  for (const unsigned long number : numbers.mapped()) requests.push_back(Take(module, number));
  return requests;
}

void Requests::FailAll(Peer& module, const Error& error) {
  while (!module.requests.open.empty())
    Fail(module, Take(module, module.requests.open.begin()->first), error);
}

void Requests::Forget(Peer& module) {
  while (!module.requests.open.empty()) Take(module, module.requests.open.begin()->first);
}

}  // namespace am
