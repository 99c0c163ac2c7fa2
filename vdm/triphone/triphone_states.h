#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "vm_protocol/core/phonemes.h"

namespace vdm {

/// A phoneme between its neighbours.
struct Triphone {
  std::string left, centre, right;

  auto operator<=>(const Triphone&) const = default;
};

/// Beginning, middle and end of a phoneme.
inline constexpr std::size_t kStates = 3;

/// One state of a triphone and the instants it lasts: `first` up to `end`, excluded; none of them
/// in a phoneme shorter than three instants.
struct TriphoneState {
  Triphone triphone;
  std::size_t state = 0;
  std::size_t first = 0, end = 0;
};

/// The states of spoken phonemes, one after the other, at instants `step_ms` apart from the
/// beginning on; each phoneme is divided into three parts of the same length. Beyond the ends is
/// "pau". REQUIRES: step_ms > 0.
std::vector<TriphoneState> StatesOf(const vm::PhonemeList& phonemes, double step_ms);

}  // namespace vdm
