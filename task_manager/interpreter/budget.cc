#include "task_manager/interpreter/budget.h"

#include <ctime>

#include "task_manager/interpreter/signals.h"

namespace vxml {
namespace {

std::chrono::nanoseconds ThreadTime() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return std::chrono::seconds(time.tv_sec) + std::chrono::nanoseconds(time.tv_nsec);
}

}  // namespace

void Budget::Renew() {
  spent_ = 0;
  began_ = ThreadTime();
  used_up_ = false;
}

void Budget::Step(std::size_t cost) {
  spent_ += cost;
  const std::chrono::nanoseconds now = ThreadTime();
  if (!used_up_) {
    if (spent_ <= steps_ && now - began_ <= time_) return;
    used_up_ = true;
    steps_at_end_ = spent_ + kMoreSteps;
    end_ = now + kMoreTime;
    ThrowEvent("error.noresource", "more than " + std::to_string(steps_) +
                                       " elements executed or more than " +
                                       std::to_string(time_.count()) +
                                       " ms of the processor used without waiting for input");
  }
  if (spent_ > steps_at_end_ || now > end_) throw ExitSession{"error.noresource"};
}

}  // namespace vxml
