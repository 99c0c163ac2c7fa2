#include "agent_manager/routing/back_pressure.h"

#include <algorithm>
#include <utility>

namespace am {
namespace {

constexpr vm::Time kLookAgain = std::chrono::milliseconds(1);  // at a reader that is full

}  // namespace

BackPressure::BackPressure(vm::Scheduler& clock, Directory& directory, const Limits& limits,
                           OnCutOff on_cut_off)
    : clock_(clock), directory_(directory), limits_(limits), on_cut_off_(std::move(on_cut_off)) {}

bool BackPressure::Hold(Peer& sender) const {
  if (lockstep_) return false;
  if (++sender.flow.held_by == 1) sender.link->PauseReading();
  return true;
}

void BackPressure::LetGo(Peer& sender) {
  if (--sender.flow.held_by == 0) sender.link->ResumeReading();
}

void BackPressure::Meter(Peer& sender, std::size_t bytes) {
  if (lockstep_ || (limits_.messages_per_s == 0 && limits_.bytes_per_s == 0)) return;
  FlowState& flow = sender.flow;
  const vm::Time now = clock_.Now();
  const vm::Time wait =
      std::max(flow.messages.Take(1, limits_.messages_per_s, now),
               flow.bytes.Take(static_cast<double>(bytes), limits_.bytes_per_s, now));
  if (wait <= vm::Time(0) || flow.throttled) return;
  flow.throttled = true;
  ++sender.traffic.throttled;
  Hold(sender);
  clock_.After(wait, [this, key = sender.key] {
    Peer* const held = directory_.ByKey(key);
    if (held == nullptr) return;
    held->flow.throttled = false;
    LetGo(*held);
  });
}

void BackPressure::AfterSend(Peer& receiver, PeerKey commander) {
  const std::size_t backlog = receiver.link->backlog_bytes();
  if (backlog <= limits_.backlog_bytes / 2) return;
  if (backlog > limits_.backlog_bytes)
    return CutOff(receiver, "more than " + std::to_string(limits_.backlog_bytes) +
                                " bytes wait for it: it does not read fast enough");
  Peer* const sender = directory_.ByKey(commander);
  if (sender == nullptr || commander == receiver.key || lockstep_) return;
  FlowState& flow = receiver.flow;
  if (!flow.holds.insert(commander).second) return;
  ++sender->traffic.held;
  Hold(*sender);
  if (flow.holds.size() > 1) return;
  flow.full_since = clock_.Now();
  flow.least_backlog = backlog;
  Watch(receiver);
}

void BackPressure::Watch(Peer& reader) {
  reader.flow.timer = clock_.After(kLookAgain, [this, key = reader.key] { Look(key); });
}

void BackPressure::Look(PeerKey key) {
  Peer* const reader = directory_.ByKey(key);
  if (reader == nullptr) return;
  FlowState& flow = reader->flow;
  flow.timer = 0;
  const std::size_t backlog = reader->link->backlog_bytes();
  if (backlog <= limits_.backlog_bytes / 4) return Release(*reader);
  if (backlog < flow.least_backlog) {
    flow.least_backlog = backlog;
    flow.full_since = clock_.Now();
  }
  if (clock_.Now() - flow.full_since >= std::chrono::milliseconds(limits_.stall_ms))
    return CutOff(*reader, "it has read nothing for " + std::to_string(limits_.stall_ms) +
                               " ms while others wait for it");
  Watch(*reader);
}

void BackPressure::Release(Peer& reader) {
  clock_.Cancel(std::exchange(reader.flow.timer, 0));
  for (const PeerKey key : std::exchange(reader.flow.holds, {})) {
    if (Peer* const sender = directory_.ByKey(key)) LetGo(*sender);
  }
}

void BackPressure::CutOff(Peer& peer, const std::string& why) {
  if (std::exchange(peer.flow.cut_off, true)) return;
  on_cut_off_(peer.key, why);
}

}  // namespace am
