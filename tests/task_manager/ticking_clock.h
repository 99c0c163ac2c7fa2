#pragma once

#include <chrono>
#include <memory>

#include "task_manager/script/engine.h"

namespace vxml_test {

/// Clocks that go on by `tick` each time a script engine looks at them: its limit of time is then a
/// number of looks, the same on every machine.
inline vxml::script::Clocks TickingClocks(
    std::chrono::nanoseconds tick = std::chrono::microseconds(20)) {
  const auto now = std::make_shared<std::chrono::nanoseconds>(0);
  const auto look = [now, tick] { return *now += tick; };
  return {look, look};
}

}  // namespace vxml_test
