#include "vm_protocol/core/scheduler.h"

#include <cmath>
#include <cstdlib>
#include <utility>

namespace vm {

std::string FormatMs(Time time) {
  const auto us = time.count();
  const auto magnitude = us < 0 ? -us : us;
  std::string text = (us < 0 ? "-" : "") + std::to_string(magnitude / 1000);
  if (auto fraction = magnitude % 1000; fraction != 0) {
    std::string digits = std::to_string(fraction);
    digits.insert(0, 3 - digits.size(), '0');
    while (digits.back() == '0') digits.pop_back();
    text += "." + digits;
  }
  return text;
}

Result<Time> ParseMs(std::string_view text) {
  constexpr double kLimit = 1e12;
  // strtod also takes hexadecimal, "nan" and "inf": only plain decimals are numbers here.
  if (text.empty() || text.find_first_not_of("0123456789.eE+-") != std::string_view::npos) {
    return Fail(Errc::kBadValue,
                "found '" + std::string(text) + "', expected a number of milliseconds");
  }
  const std::string copy(text);
  char* end = nullptr;
  const double value = std::strtod(copy.c_str(), &end);
  if (end != copy.c_str() + copy.size() || !std::isfinite(value) || std::fabs(value) > kLimit) {
    return Fail(Errc::kBadValue, "found '" + copy + "', expected a number of milliseconds");
  }
  return Time(static_cast<Time::rep>(std::llround(value * 1000.0)));
}

TimerId VirtualScheduler::At(Time when, std::function<void()> action) {
  const TimerId id = ++last_id_;
  if (when < now_) when = now_;
  timers_.emplace(std::pair(when, id), std::move(action));
  when_.emplace(id, when);
  return id;
}

void VirtualScheduler::Cancel(TimerId id) {
  const auto found = when_.find(id);
  if (found == when_.end()) return;
  timers_.erase({found->second, id});
  when_.erase(found);
}

std::optional<Time> VirtualScheduler::Next() const {
  if (timers_.empty()) return std::nullopt;
  return timers_.begin()->first.first;
}

void VirtualScheduler::RunUntil(Time until) {
  while (!timers_.empty() && timers_.begin()->first.first <= until) {
    auto node = timers_.extract(timers_.begin());
    if (node.key().first > now_) now_ = node.key().first;
    when_.erase(node.key().second);
    node.mapped()();
  }
  if (until > now_) now_ = until;
}

bool VirtualScheduler::RunUntilIdle(Time limit) {
  while (const auto next = Next()) {
    if (*next > limit) return false;
    RunUntil(*next);
  }
  return true;
}

}  // namespace vm
