#include "agent_manager/routing/work_queue.h"

namespace am {
namespace {

constexpr std::size_t kKeptItems = 16384;  // what a flood needed beyond this is given back
constexpr std::size_t kLookAtClock = 4;    // items: cheap ones shall not pay for it

std::size_t BytesOf(const Envelope& envelope) {
  return envelope.message.value.size() + envelope.message.slot.size();
}

bool IsCaused(const Envelope& envelope) {
  return !envelope.machine.empty() || envelope.origin.lines_left;
}

}  // namespace

PeerKey WorkQueue::CauseOf(const Item& item) {
  const auto* const work = std::get_if<Work>(&item);
  return work != nullptr ? work->cause : std::get<Envelope>(item).origin.peer;
}

void WorkQueue::PushCaused(Envelope envelope) {
  if (IsCaused(envelope)) {
    Caused& caused = caused_[envelope.origin.peer];
    ++caused.items;
    caused.bytes += BytesOf(envelope);
  }
  items_.emplace_back(std::in_place_type<Envelope>, std::move(envelope));
}

WorkQueue::Caused WorkQueue::CausedBy(PeerKey cause) const {
  const auto found = caused_.find(cause);
  return found == caused_.end() ? Caused{} : found->second;
}

void WorkQueue::Take(Item& item, const std::function<void(Item& item)>& take) {
  if (const auto* const envelope = std::get_if<Envelope>(&item);
      envelope != nullptr && IsCaused(*envelope)) {
    const auto caused = caused_.find(envelope->origin.peer);
    caused->second.bytes -= BytesOf(*envelope);
    if (--caused->second.items == 0) caused_.erase(caused);
  }
  take(item);
}

void WorkQueue::PutIntoLane(PeerKey cause, Item item) {
  auto& lane = lanes_[cause];
  lane.push_back(std::move(item));
  if (lane.size() == 1) on_lane_(cause, true);
}

void WorkQueue::TakeFromLane(const std::function<void(Item& item)>& take) {
  auto lane = lanes_.upper_bound(last_lane_);
  if (lane == lanes_.end()) lane = lanes_.begin();
  last_lane_ = lane->first;
  Item item = std::move(lane->second.front());
  lane->second.pop_front();
  if (lane->second.empty()) {
    lanes_.erase(lane);
    on_lane_(last_lane_, false);
  }
  Take(item, take);
}

bool WorkQueue::Drain(const std::function<void(Item& item)>& take) {
  if (empty()) return false;
  const auto end = now_() + kTurn;
  bool late = false;
  std::size_t until_look = kLookAtClock;
  taken_.swap(items_);
  for (Item& item : taken_) {
    if (late || !lanes_.empty()) {
      // The hub's own is short, and everybody's: it waits for nobody.
      const PeerKey cause = CauseOf(item);
      if (cause != kHub && (late || lanes_.contains(cause))) {
        PutIntoLane(cause, std::move(item));
        continue;
      }
    }
    Take(item, take);
    if (--until_look > 0 || lockstep_) continue;
    until_look = kLookAtClock;
    late = now_() >= end;
  }
  taken_.clear();
  if (taken_.capacity() > kKeptItems) taken_ = {};
  // At least one, however much others have to say.
  while (!lanes_.empty()) {
    TakeFromLane(take);
    if (!lockstep_ && now_() >= end) break;
  }
  return true;
}

}  // namespace am
