// Messages on their way through the rules of the configuration.

#include <utility>

#include "agent_manager/hub.h"
#include "agent_manager/hub_peer.h"

namespace am {

using vm::Errc;
using vm::Fail;
using vm::Message;

void Hub::CarryOut(const std::string& from, const Rules::Outcome& outcome) {
  for (const std::string& note : outcome.notes) Notice(note);
  for (const auto& [receiver, copy] : outcome.copies) {
    Peer* peer = Find(receiver);
    if (peer == nullptr) continue;
    Message message = copy;
    message.to.clear();
    message.tag.clear();
    const bool report = copy.command == vm::Command::kRep || copy.command == vm::Command::kTell;
    message.from = report ? from : "";
    report ? Send(*peer, message) : Forward(*peer, std::move(message), kHub, nullptr);
  }
}

void Hub::DeliverByRule(const std::string& sender_name, PeerKey asker, const std::string& receiver,
                        const Message& message, OnAnswer done) {
  std::string to = receiver;
  Message changed = message;
  const Rules::Outcome outcome = rules_.Apply(sender_name, to, changed, clock_.Now());
  CarryOut(sender_name, outcome);
  if (outcome.dropped) {
    // Nobody waits for an answer that never comes; who did not ask for one hears nothing.
    if (done || !message.tag.empty())
      AnswerTo(asker, "AM", message, Fail(Errc::kAccess, *outcome.dropped), done);
    return;
  }
  if (outcome.delay <= vm::Time(0))
    return DeliverNow(sender_name, asker, to, changed, std::move(done));
  ++held_;
  clock_.After(outcome.delay,
               [this, sender_name, asker, to, changed, done = std::move(done)]() mutable {
                 --held_;
                 DeliverNow(sender_name, asker, to, changed, std::move(done));
               });
}

void Hub::ReportByRule(Peer& sender, Message message) {
  std::string to = message.to.size() == 1 ? message.to.front() : "";
  const std::string before = to;
  const Rules::Outcome outcome = rules_.Apply(sender.name, to, message, clock_.Now());
  CarryOut(sender.name, outcome);
  if (outcome.dropped) return;
  if (to != before) message.to = {to};
  if (outcome.delay <= vm::Time(0)) return ReportNow(sender, std::move(message));
  ++held_;
  clock_.After(outcome.delay, [this, key = sender.key, message = std::move(message)] {
    --held_;
    if (Peer* peer = ByKey(key)) ReportNow(*peer, message);
  });
}

}  // namespace am
