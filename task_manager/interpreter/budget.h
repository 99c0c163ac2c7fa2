#pragma once

#include <chrono>
#include <cstddef>
#include <ctime>

namespace vxml {

/// What a session may do between two waits for its user: steps, and processor time of its thread,
/// over scripts, items and events together.
class Budget {
 public:
  enum class Left { kEnough, kUsedUp, kNothing };

  Budget(std::size_t steps, std::chrono::nanoseconds time) : steps_(steps), time_(time) {}

  /// Thread: the session's; its time counts from here.
  void Renew() {
    spent_ = 0;
    began_ = ThreadTime();
    used_up_ = false;
  }
  /// kUsedUp once, so that handlers of that event can run, and kNothing when they, too, have gone
  /// on for too long.
  Left Spend(std::size_t cost) {
    spent_ += cost;
    if (spent_ <= steps_ && ThreadTime() - began_ <= time_) return Left::kEnough;
    if (!used_up_) {
      used_up_ = true;
      steps_at_end_ = spent_ + kMoreSteps;
      end_ = ThreadTime() + kMoreTime;
      return Left::kUsedUp;
    }
    return spent_ <= steps_at_end_ && ThreadTime() <= end_ ? Left::kEnough : Left::kNothing;
  }

 private:
  static constexpr std::size_t kMoreSteps = 2000;
  static constexpr std::chrono::milliseconds kMoreTime{500};

  static std::chrono::nanoseconds ThreadTime() {
    timespec time{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return std::chrono::seconds(time.tv_sec) + std::chrono::nanoseconds(time.tv_nsec);
  }

  std::size_t steps_;
  std::chrono::nanoseconds time_;
  std::size_t spent_ = 0;
  std::chrono::nanoseconds began_{};
  bool used_up_ = false;
  std::size_t steps_at_end_ = 0;
  std::chrono::nanoseconds end_{};
};

}  // namespace vxml
