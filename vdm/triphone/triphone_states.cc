#include "vdm/triphone/triphone_states.h"

#include <cmath>

namespace vdm {

std::vector<TriphoneState> StatesOf(const vm::PhonemeList& phonemes, double step_ms) {
  const std::string silence = "pau";
  std::vector<TriphoneState> states;
  states.reserve(kStates * phonemes.size());
  double start_ms = 0;
  for (std::size_t i = 0; i < phonemes.size(); ++i) {
    const Triphone triphone{.left = i == 0 ? silence : phonemes[i - 1].name,
                            .centre = phonemes[i].name,
                            .right = i + 1 == phonemes.size() ? silence : phonemes[i + 1].name};
    const auto length_ms = static_cast<double>(phonemes[i].duration.count());
    const auto instant = [&](std::size_t state) {
      const double ms = start_ms + length_ms * static_cast<double>(state) / kStates;
      return static_cast<std::size_t>(std::ceil(ms / step_ms));
    };
    for (std::size_t state = 0; state < kStates; ++state) {
      states.push_back({triphone, state, instant(state), instant(state + 1)});
    }
    start_ms += length_ms;
  }
  return states;
}

}  // namespace vdm
