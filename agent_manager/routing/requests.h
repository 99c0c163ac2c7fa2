#pragma once

#include <string>
#include <vector>

#include "agent_manager/routing/outbox.h"

namespace am {

/// The requests that modules have not answered yet, with one limit (Limits::pending) and one
/// time-out (kAnswerLimit) for both dialects: those that know tags, where ours comes back, and
/// those of the original, where the next report of the slot is the answer to `inq`. Thread: the
/// scheduler's. All that it is given outlives it.
class Requests {
 public:
  static constexpr vm::Time kAnswerLimit = std::chrono::minutes(2);
  /// One module has at most kPeersShares * Limits::pending open requests; beyond it the oldest of
  /// the peer that has most of them is answered LIMIT.
  static constexpr std::size_t kPeersShares = 16;
  Requests(vm::Scheduler& clock, Directory& directory, Outbox& outbox, BackPressure& back_pressure,
           const Limits& limits);

  /// Returns the tag to send. Beyond the limit the asker's own oldest request is answered LIMIT.
  std::string Add(Peer& module, Request request);
  /// A question without a tag; the next report of its slot answers it.
  void AddBySlot(Peer& module, Request request);
  /// True if the report was an answer (also a late one): it is then dealt with.
  bool Resolve(Peer& module, const vm::Message& rep);
  /// The questions which this report of a slot answers.
  std::vector<Request> TakeBySlot(Peer& module, const std::string& slot);
  /// Answers all open requests to this module with the error.
  void FailAll(Peer& module, const vm::Error& error);
  /// A message of this peer waits to be sent and counts as an unanswered request. A peer with more
  /// than half of Limits::pending unanswered requests is not read from until only a quarter are
  /// left, unless others wait for its own answers.
  void CountUnanswered(PeerKey asker);
  void UncountUnanswered(PeerKey asker);
  /// Forgets all open requests to this module without an answer.
  void Forget(Peer& module);

 private:
  unsigned long Insert(Peer& module, Request request);
  Request Take(Peer& module, unsigned long number);
  void Refuse(Peer& module, PeerKey asker);
  static void GoOnReading(Peer& peer);
  void Fail(const Peer& module, const Request& request, const vm::Error& error);
  void Watch(Peer& module);
  void Expire(PeerKey key);

  vm::Scheduler& clock_;
  Directory& directory_;
  Outbox& outbox_;
  BackPressure& back_pressure_;
  const Limits& limits_;
  unsigned long last_number_ = 0;
};

}  // namespace am
