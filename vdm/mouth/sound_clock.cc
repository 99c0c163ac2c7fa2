#include "vdm/mouth/sound_clock.h"

#include <algorithm>
#include <utility>

namespace vdm {
namespace {

constexpr vm::Time kAlike{60'000};  // what was made up for and the hole: arrivals shake

}  // namespace

SoundClock::Places SoundClock::Add(vm::Time now, std::size_t samples) {
  const bool first = count_ == 0;
  count_ += samples;
  const vm::Time arrival =
      now - LengthOf(count_);  // of sample 0, if this piece has just been heard
  const vm::Time late = arrival - base_;
  const vm::Time since_last = now - std::exchange(last_, now);
  if (hole_ > vm::Time(0) && now - resumed_ > kMakesUpWithin) hole_ = vm::Time(0);
  if (first || late > kStall) {
    hole_ = first ? vm::Time(0) : hole_ + late;
    resumed_ = now;
    count_ = samples;
    base_ = now - LengthOf(count_);
    return Places::kBeginAnew;
  }
  // A burst is over with the first piece that comes at the pace of time.
  const bool paced = since_last >= LengthOf(samples) / 2;
  if (hole_ > vm::Time(0) && paced && std::abs((late + hole_).count()) <= kAlike.count()) {
    base_ -= std::exchange(hole_, vm::Time(0));
    return Places::kCameEarlier;
  }
  const vm::Time most = since_last / 2000;
  base_ += std::clamp(late, -most, most);
  return Places::kGoOn;
}

}  // namespace vdm
