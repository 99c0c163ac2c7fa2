#include "fsm/motion/person.h"

#include "fsm/motion/random.h"

namespace fsm {
namespace {
enum Stream : std::uint64_t { kLateSide = 200, kLag };
}

ExpressionMotion::Sides SideLagsOf(std::uint64_t seed) {
  ExpressionMotion::Sides lag_ms{};
  lag_ms[RandomAt(seed, kLateSide, 0) < 0 ? 0 : 1] = 30 + 10 * RandomAt(seed, kLag, 0);
  return lag_ms;
}

}  // namespace fsm
