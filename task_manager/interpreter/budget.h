#pragma once

#include <chrono>
#include <cstddef>

namespace vxml {

/// What a session may do between two waits for its user: steps, and processor time of its thread,
/// over scripts, items and events together. Thread: the session's.
class Budget {
 public:
  Budget(std::size_t steps, std::chrono::milliseconds time) : steps_(steps), time_(time) {}

  /// The user was waited for: the count begins anew.
  void Renew();
  /// Counts an element or item executed. Throws error.noresource when the budget is used up, once,
  /// so that handlers of that event can run, and ends the session when they, too, go on too long.
  void Step(std::size_t cost = 1);
  /// Counts what is said, logged or sent: a step for every 256 bytes.
  void StepForBytes(std::size_t bytes) { Step(bytes / kBytesOfAStep); }

 private:
  static constexpr std::size_t kBytesOfAStep = 256;
  static constexpr std::size_t kMoreSteps = 2000;
  static constexpr std::chrono::milliseconds kMoreTime{500};

  std::size_t steps_;
  std::chrono::milliseconds time_;
  std::size_t spent_ = 0;
  std::chrono::nanoseconds began_{};
  bool used_up_ = false;
  std::size_t steps_at_end_ = 0;
  std::chrono::nanoseconds end_{};
};

}  // namespace vxml
