#include "vdm/mouth/sound_clock.h"

#include <algorithm>

namespace vdm {

bool SoundClock::Add(vm::Time now, std::size_t samples) {
  const bool first = count_ == 0;
  count_ += samples;
  const vm::Time arrival =
      now - LengthOf(count_);  // of sample 0, if this piece has just been heard
  const vm::Time late = arrival - base_;
  const bool anew = first || late > kStall;
  if (anew) {
    base_ = arrival;
  } else {
    const vm::Time most = (now - last_) / 2000;
    base_ += std::clamp(late, -most, most);
  }
  last_ = now;
  return anew;
}

}  // namespace vdm
