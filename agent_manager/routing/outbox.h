#pragma once

#include <functional>
#include <set>
#include <string>

#include "agent_manager/log/session_log.h"
#include "agent_manager/routing/back_pressure.h"
#include "agent_manager/routing/directory.h"
#include "agent_manager/routing/work_queue.h"

namespace am {

/// The way out: counts, logs and sends what goes to peers, and hands answers to whoever asked.
/// Thread: the scheduler's. All that it is given outlives it.
class Outbox {
 public:
  /// A diagnosis for people; `about`: the peer whose line it concerns, kHub if none.
  using OnNotice = std::function<void(const std::string& text, PeerKey about)>;
  Outbox(vm::Scheduler& clock, SessionLog& log, Directory& directory, BackPressure& back_pressure,
         WorkQueue& queue);

  /// `commander`: the peer whose command this is, and who waits if the receiver is full; else kHub.
  void Send(Peer& receiver, const vm::Message& message, PeerKey commander);
  /// One line in the log and one formatting, however many receive it.
  void SendAll(const std::set<PeerKey>& receivers, const vm::Message& message, PeerKey commander);
  /// Without a line in the log.
  void Write(Peer& receiver, const vm::Message& message, PeerKey commander);

  /// The answer to `request`, of one of the hub's parts (`done`, called from the queue) or of a
  /// peer, which hears a success only if it asked for one.
  void Answer(PeerKey asker, const std::string& from, const vm::Message& request,
              const vm::Result<std::string>& result, const OnAnswer& done);
  /// A line of this peer's that cannot be dealt with. A flood of them is not a flood of reports.
  /// `tag`: the request's, if it could be read.
  void Complain(Peer& sender, const vm::Error& error, const std::string& tag = "");

  /// As Complain, to people only. True if it is one of a flood.
  bool CountComplaint(Peer& sender, const vm::Error& error);

  /// Told of everything that goes to a peer, before it goes.
  void set_before_sending(std::function<void(Peer& receiver)> before_sending) {
    before_sending_ = std::move(before_sending);
  }
  void set_on_notice(OnNotice on_notice) { on_notice_ = std::move(on_notice); }
  void Notice(const std::string& text, PeerKey about = kHub) const;

 private:
  void Deliver(Peer& receiver, const Outgoing& outgoing, PeerKey commander);

  vm::Scheduler& clock_;
  SessionLog& log_;
  Directory& directory_;
  BackPressure& back_pressure_;
  WorkQueue& queue_;
  std::function<void(Peer& receiver)> before_sending_;
  OnNotice on_notice_;
};

/// The slot a request's answer names; the command's word if it has none.
std::string SlotOf(const vm::Message& request);

}  // namespace am
