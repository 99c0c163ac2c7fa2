#include "agent_manager/routing/hub.h"

#include <algorithm>
#include <utility>

#include "agent_manager/routing/own_names.h"
#include "vm_protocol/core/guarded.h"

namespace am {

using vm::Errc;
using vm::Fail;
using vm::Message;
using vm::Result;

namespace {

/// How long a peer whose input has ended is kept for its answers.
constexpr vm::Time kHalfClosedLimit = std::chrono::minutes(5);
constexpr std::uint64_t kShareForOthers = 8;  // of limits.peers, which guests cannot take

}  // namespace

Hub::Hub(vm::Scheduler& clock, SessionLog& log)
    : clock_(clock),
      queue_([this](PeerKey peer, bool begins) { HoldWhileInLane(peer, begins); }),
      back_pressure_(
          clock, directory_, limits_,
          [this](PeerKey peer, const std::string& why) {
            outbox_.Notice("@" + directory_.NameOf(peer) + ": " + why + ", it is cut off");
            Leave(peer, why);
          }),
      outbox_(clock, log, directory_, back_pressure_, queue_),
      requests_(clock, directory_, outbox_, back_pressure_, limits_),
      grants_(clock, outbox_, requests_),
      forwarder_(clock, directory_, outbox_, requests_, grants_, access_, limits_),
      clocks_(clock, directory_, outbox_, requests_, grants_, forwarder_,
              [this](Peer& module) {
                if (on_presence_) on_presence_(module.name, true, "");
              }),
      router_(clock, log, directory_, outbox_, requests_, forwarder_, queue_, access_, limits_) {
  outbox_.set_before_sending([this](Peer& receiver) { grants_.BeforeSending(receiver); });
  router_.set_on_module([this](Peer& peer) { clocks_.Probe(peer); });
}

Hub::~Hub() = default;

void Hub::set_lockstep(bool lockstep) {
  queue_.set_lockstep(lockstep);
  back_pressure_.set_lockstep(lockstep);
  grants_.set_lockstep(lockstep);
}

void Hub::HoldWhileInLane(PeerKey key, bool begins) {
  Peer* const peer = directory_.ByKey(key);
  if (peer == nullptr) return;
  if (begins) {
    peer->flow.in_lane = back_pressure_.Hold(*peer);
  } else if (std::exchange(peer->flow.in_lane, false)) {
    BackPressure::LetGo(*peer);
  }
}

Result<PeerKey> Hub::Add(std::unique_ptr<Peer> peer) {
  // Modules of other agents are bounded by the bridge that brings them.
  const bool remote = peer->kind == PeerKind::kRemote;
  const auto there_now =
      static_cast<std::uint64_t>(std::ranges::count_if(directory_.peers(), [](const auto& entry) {
        return entry.second->kind != PeerKind::kRemote;
      }));
  if (!remote && there_now >= limits_.peers) {
    peer->link->Close();
    return Fail(Errc::kLimit, "more than " + std::to_string(limits_.peers) + " peers");
  }
  // Guests leave room for those who may more.
  const std::uint64_t most_guests = limits_.peers - limits_.peers / kShareForOthers;
  if (!remote && peer->role == Role::kGuest && GuestsThere() >= most_guests) {
    peer->link->Close();
    return Fail(Errc::kLimit, "more than " + std::to_string(most_guests) + " guests");
  }
  peer->key = ++last_key_;
  if (peer->name.empty()) peer->name = FreeName();
  const auto added = directory_.Add(peer);
  if (!added) {
    peer->link->Close();
    return std::unexpected(added.error());
  }
  Peer& there = **added;
  if (there.kind == PeerKind::kConsole) Subscribe(there.key, {"*"});
  if (there.kind == PeerKind::kModule && there.dialect != Dialect::kOriginal) {
    clocks_.Probe(there);
  } else if (there.kind == PeerKind::kModule) {
    queue_.Post([this, name = there.name] {
      if (on_presence_ && directory_.IsPresent(name)) on_presence_(name, true, "");
    });
  }
  return there.key;
}

std::string Hub::FreeName() {
  std::string name;
  do name = "CLIENT" + std::to_string(++last_name_);
  while (directory_.Find(name) != nullptr);  // others may have taken such names
  return name;
}

void Hub::Reserve(const std::set<std::string>& names) {
  directory_.Reserve({});
  for (const std::string& name : names) {
    Peer* const holder = directory_.Find(name);
    if (holder == nullptr || holder->configured || IsReservedName(name)) continue;
    const std::string other = FreeName();
    if (!directory_.Rename(holder->key, other)) continue;
    AnnounceRename(name, other);
    outbox_.Complain(
        *holder,
        {Errc::kBusy, "the name @" + name + " is that of a module now, you are @" + other, 0});
  }
  directory_.Reserve(names);
}

std::uint64_t Hub::GuestsThere() const {
  return static_cast<std::uint64_t>(
      std::ranges::count_if(directory_.peers(), [](const auto& entry) {
        return entry.second->role == Role::kGuest && entry.second->kind != PeerKind::kRemote;
      }));
}

Result<PeerKey> Hub::Attach(std::unique_ptr<Link> link, PeerKind kind, Role role,
                            const std::string& name, Dialect dialect) {
  auto peer = std::make_unique<Peer>();
  peer->name = name;
  peer->kind = kind;
  peer->role = role;
  peer->dialect = dialect;
  peer->link = std::move(link);
  return Add(std::move(peer));
}

Result<PeerKey> Hub::AttachModule(std::unique_ptr<Link> link, const std::string& name,
                                  Dialect dialect, const std::string& folder) {
  auto peer = std::make_unique<Peer>();
  peer->name = name;
  peer->kind = PeerKind::kModule;
  peer->role = Role::kModule;
  peer->dialect = dialect;
  peer->configured = true;
  peer->folder = folder;
  peer->link = std::move(link);
  return Add(std::move(peer));
}

Peer* Hub::CountInput(PeerKey key, std::size_t bytes) {
  Peer* const sender = directory_.ByKey(key);
  if (sender == nullptr || sender->flow.cut_off) return nullptr;
  sender->spoken = true;
  ++sender->traffic.messages_in;
  sender->traffic.bytes_in += bytes;
  return sender;
}

void Hub::Receive(PeerKey key, Result<std::string_view> line) {
  const std::size_t bytes = line ? line->size() + 1 : 0;
  Peer* const sender = CountInput(key, bytes);
  if (sender == nullptr) return;
  auto message = line ? vm::ParseMessage(*line) : Result<Message>(std::unexpected(line.error()));
  if (message) return Take(*sender, std::move(*message), bytes);
  back_pressure_.Meter(*sender, bytes);
  if (message.error().code == Errc::kEmpty) return;
  queue_.Post(
      [this, key, error = message.error(), tag = line ? vm::TagOf(*line) : std::string()] {
        if (Peer* const peer = directory_.ByKey(key)) outbox_.Complain(*peer, error, tag);
      },
      key);
}

void Hub::Receive(PeerKey key, Message message) {
  const std::size_t bytes = message.value.size();
  if (Peer* const sender = CountInput(key, bytes)) Take(*sender, std::move(message), bytes);
}

void Hub::Take(Peer& sender, Message message, std::size_t bytes) {
  // An answer was asked for, and is counted with the requests of the peer that asked.
  const bool answer =
      message.command == vm::Command::kRep && !message.tag.empty() && !sender.requests.open.empty();
  if (!answer) back_pressure_.Meter(sender, bytes);
  queue_.Push(std::move(message), {.peer = sender.key, .role = sender.role});
}

void Hub::Leave(PeerKey key, const std::string& reason) {
  queue_.Post([this, key, reason] { Evict(key, reason); }, key);
}

void Hub::EndInput(PeerKey key) {
  queue_.Post(
      [this, key] {
        if (directory_.ByKey(key) != nullptr) half_closed_.try_emplace(key);
      },
      key);
}

/// Those who speak no more go once they have heard what they asked for.
void Hub::ReleaseHalfClosed() {
  for (auto at = half_closed_.begin(); at != half_closed_.end();) {
    const PeerKey key = at->first;
    const Peer* const peer = directory_.ByKey(key);
    const auto leave = [this, key] { Leave(key, "end of input"); };
    const bool awaited =
        peer != nullptr && (peer->asked.open > 0 || (awaited_by_ && awaited_by_(key)));
    if (awaited || (peer != nullptr && peer->link->backlog_bytes() > 0)) {
      if (at->second == 0) at->second = clock_.After(kHalfClosedLimit, leave);
      ++at;
      continue;
    }
    clock_.Cancel(at->second);
    at = half_closed_.erase(at);
    leave();
  }
}

void Hub::FailRequests(const vm::Error& error) {
  for (const auto& [key, peer] : directory_.peers()) requests_.FailAll(*peer, error);
}

void Hub::WhenAllSent(std::function<void()> done) {
  // The last of the links lets go of it.
  const std::shared_ptr<void> all(nullptr, [done = std::move(done)](void*) { done(); });
  for (const auto& [key, peer] : directory_.peers()) peer->link->WhenSent([all] {});
}

void Hub::Evict(PeerKey key, const std::string& reason) {
  const std::unique_ptr<Peer> peer = directory_.Remove(key);
  if (peer == nullptr) return;
  CountSubscriptions(*peer, -1);
  back_pressure_.Release(*peer);
  peer->link->Close();
  requests_.FailAll(*peer,
                    {Errc::kUnavailable, "@" + peer->name + " has gone (" + reason + ")", 0});
  forwarder_.Forget(*peer);
  for (vm::SlotMachine* const machine : directory_.Machines()) machine->PeerGone(key);
  if (on_presence_) on_presence_(peer->name, false, reason);
}

bool Hub::Drain() {
  // What comes while these are dealt with waits for the next time: the loop looks at its
  // descriptors and timers in between, whatever the hub's parts say to each other.
  const bool any = queue_.Drain([this](WorkQueue::Item& item) { DealWith(item); });
  if (!half_closed_.empty()) ReleaseHalfClosed();
  return any || !queue_.empty();
}

void Hub::DealWith(WorkQueue::Item& item) {
  if (const auto* const work = std::get_if<Work>(&item)) {
    if (const auto done = vm::Guarded(work->act); !done)
      ReportFailure(work->cause, done.error().text, std::nullopt);
    return;
  }
  // Routing takes the envelope apart; whoever waits for an answer has one all the same.
  Envelope& envelope = std::get<Envelope>(item);
  const PeerKey blamed = envelope.origin.peer;
  const std::optional<Asked> asked = AskedBy(envelope);
  if (const auto routed = vm::Guarded([&] { router_.Route(envelope); }); !routed)
    ReportFailure(blamed, routed.error().text, asked);
}

std::optional<Hub::Asked> Hub::AskedBy(Envelope& envelope) {
  const Message& message = envelope.message;
  // The tag of a report is that of somebody else's question.
  const bool tagged = !message.tag.empty() && message.command != vm::Command::kRep;
  if (!tagged && !envelope.done) return std::nullopt;
  Asked asked;
  asked.asker = envelope.machine.empty() ? envelope.origin.peer : kHub;
  asked.request.command = message.command;
  asked.request.tag = message.tag;
  asked.request.slot = message.slot;
  if (envelope.done) {
    const vm::Reply once(std::move(envelope.done));
    asked.done = [once](const Result<std::string>& answer) {
      answer ? once.Ok(*answer) : once.Fail(answer.error());
    };
    envelope.done = asked.done;
  }
  return asked;
}

void Hub::ReportFailure(PeerKey key, const std::string& what, const std::optional<Asked>& asked) {
  const vm::Error error{Errc::kInternal, "a message could not be dealt with: " + what, 0};
  Peer* const peer = directory_.ByKey(key);
  if (peer == nullptr) {
    outbox_.Notice(vm::FormatError(error));
  } else if (asked) {
    outbox_.CountComplaint(*peer, error);
  } else {
    outbox_.Complain(*peer, error);
  }
  if (asked)
    outbox_.Answer(asked->asker, own_name::kHub, asked->request, std::unexpected(error),
                   asked->done);
}

void Hub::AddMachine(vm::SlotMachine& machine, std::vector<std::string> aliases, bool replaceable) {
  directory_.AddMachine(machine, std::move(aliases), replaceable);
  machine.set_output([this, name = machine.module_name()](PeerKey to, const Message& said) {
    router_.FromMachine(name, to, said);
  });
}

void Hub::Ask(const std::string& sender, Message message, OnAnswer done, const Origin& origin) {
  queue_.PushCaused({std::move(message), origin, sender, std::move(done)});
}

void Hub::SayAs(const Origin& origin, Message message) {
  queue_.PushCaused({.message = std::move(message), .origin = origin});
}

Result<void> Hub::CheckCaused(const Origin& origin, std::size_t most_items) const {
  const auto caused = queue_.CausedBy(origin.peer);
  if (caused.items <= most_items && caused.bytes <= WorkQueue::kMaxCausedBytes) return {};
  return Fail(Errc::kLimit, "macros and scripts say more for this peer than can be passed on");
}

Result<void> Hub::Rename(PeerKey key, const std::string& name) {
  if (const auto checked = access_.CheckName(directory_.RoleOf(key), name); !checked)
    return checked;
  const std::string before = directory_.NameOf(key);
  const auto renamed = directory_.Rename(key, name);
  if (renamed && name != before) AnnounceRename(before, name);
  return renamed;
}

void Hub::AnnounceRename(const std::string& before, const std::string& name) {
  if (!directory_.IsModule(name) || !directory_.IsReady(name)) return;
  queue_.Post([this, before, name] {
    if (!on_presence_) return;
    on_presence_(before, false, "it is called @" + name + " now");
    if (directory_.IsPresent(name)) on_presence_(name, true, "");
  });
}

void Hub::Grant(PeerKey key, vm::Time until, OnAnswer done) {
  if (Peer* const module = directory_.ByKey(key)) grants_.Grant(*module, until, std::move(done));
}

void Hub::Subscribe(PeerKey key, const std::set<std::string>& modules) {
  Peer* const peer = directory_.ByKey(key);
  if (peer == nullptr) return;
  CountSubscriptions(*peer, -1);
  peer->subscriptions = modules;
  CountSubscriptions(*peer, 1);
}

void Hub::CountSubscriptions(const Peer& peer, int sign) {
  for (const std::string& name : peer.subscriptions) {
    std::size_t& count = subscribers_[name];
    count += static_cast<std::size_t>(sign);
    if (count == 0) subscribers_.erase(name);
  }
}

bool Hub::SendComment(PeerKey key, std::string_view text) {
  Peer* const peer = directory_.ByKey(key);
  if (peer == nullptr || peer->flow.cut_off) return false;
  peer->link->SendComment(text);
  back_pressure_.AfterSend(*peer, kHub);  // an onlooker holds nobody
  return true;
}

std::vector<PeerStatus> Hub::Status() const {
  std::vector<PeerStatus> all;
  for (const auto& [key, peer] : directory_.peers()) {
    all.push_back({peer->name, peer->kind, peer->role, peer->traffic, peer->link->backlog_bytes(),
                   peer->requests.open.size() + peer->waiting.messages.size(), peer->defined.size(),
                   peer->flow.held_by > 0});
  }
  return all;
}

}  // namespace am
