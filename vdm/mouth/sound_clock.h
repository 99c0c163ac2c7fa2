#pragma once

#include <cstdint>
#include <optional>

#include "vm_protocol/core/scheduler.h"

namespace vdm {

/// When each sample of a source was heard, though sound comes in pieces and their arrival shakes.
/// The first piece is taken to have just been heard; from there on a sample is a sixteenth of a
/// millisecond. Sound that comes faster than time is ahead of it (a program that makes speech and
/// plays it meanwhile); a piece that comes later than kStall after its time begins anew. Clocks of
/// sound drift from those of machines by some hundred millionths: the places follow arrivals by at
/// most half a millisecond a second. A hole in the arrivals may be a pause, or sound that is late:
/// if the source makes up within a second for all that it owes, the places are as if there had been
/// no hole. Pure.
class SoundClock {
 public:
  static constexpr vm::Time kStall{100'000};
  static constexpr vm::Time kMakesUpWithin{1'000'000};

  enum class Places {
    kGoOn,
    kBeginAnew,   ///< the first of the samples that came is sample 0 now
    kCameEarlier  ///< the hole before was none: all samples since were heard earlier by its length
  };
  /// So many samples came, and it is `now`.
  Places Add(vm::Time now, std::size_t samples);
  /// When the sample was heard, counted from where places began anew. REQUIRES: something came.
  vm::Time TimeOf(std::uint64_t sample) const { return base_ + LengthOf(sample); }
  /// The last sample's time; none before the first.
  std::optional<vm::Time> End() const {
    return count_ == 0 ? std::nullopt : std::optional(TimeOf(count_));
  }

 private:
  static vm::Time LengthOf(std::uint64_t samples) {
    return vm::Time(static_cast<std::int64_t>(samples * 1000 / 16));
  }
  vm::Time base_{0};  // of sample 0
  vm::Time last_{0};  // when a piece came last
  std::uint64_t count_ = 0;
  vm::Time hole_{0};     // that the source may make up for; 0: none
  vm::Time resumed_{0};  // when the hole was over
};

}  // namespace vdm
