#include "vm_protocol/core/start_time.h"

#include <array>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <optional>

namespace vm {
namespace {

using std::chrono::hours;
using std::chrono::minutes;
using std::chrono::seconds;

constexpr Time kDay = hours(24);

std::string_view Trim(std::string_view text) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
  while (!text.empty() && (text.back() == ' ' || text.back() == '\t')) text.remove_suffix(1);
  return text;
}

bool AllDigits(std::string_view text) {
  return !text.empty() && text.find_first_not_of("0123456789") == std::string_view::npos;
}

int ToInt(std::string_view digits) {
  int value = 0;
  for (const char c : digits) value = value * 10 + (c - '0');
  return value;
}

/// HH:MM:SS[.fraction of up to 6 digits]
std::optional<Time> ParseClock(std::string_view text) {
  if (text.size() < 8 || text[2] != ':' || text[5] != ':') return std::nullopt;
  const std::string_view h = text.substr(0, 2);
  const std::string_view m = text.substr(3, 2);
  const std::string_view s = text.substr(6, 2);
  if (!AllDigits(h) || !AllDigits(m) || !AllDigits(s)) return std::nullopt;
  if (ToInt(h) > 23 || ToInt(m) > 59 || ToInt(s) > 59) return std::nullopt;
  Time time = hours(ToInt(h)) + minutes(ToInt(m)) + seconds(ToInt(s));
  if (text.size() > 8) {
    std::string fraction(text.substr(9));
    if (text[8] != '.' || !AllDigits(fraction) || fraction.size() > 6) return std::nullopt;
    fraction.resize(6, '0');
    time += Time(ToInt(fraction));
  }
  return time;
}

std::unexpected<Error> Unreadable(std::string_view text) {
  return Fail(Errc::kBadValue, "found '" + std::string(text) +
                                   "', expected NOW, +MS, @MS, +HH:MM:SS.mmm or HH:MM:SS.mmm");
}

std::string FormatClock(Time time) {
  const auto us = time.count();
  std::array<char, 32> buffer{};
  std::snprintf(buffer.data(), buffer.size(), "%02d:%02d:%02d.%03d",
                static_cast<int>(us / 3'600'000'000 % 100), static_cast<int>(us / 60'000'000 % 60),
                static_cast<int>(us / 1'000'000 % 60), static_cast<int>(us / 1000 % 1000));
  return buffer.data();
}

}  // namespace

Result<StartTime> ParseStartTime(std::string_view text) {
  const std::string_view whole = Trim(text);
  if (whole.size() == 3 && (whole[0] == 'N' || whole[0] == 'n') &&
      (whole[1] == 'O' || whole[1] == 'o') && (whole[2] == 'W' || whole[2] == 'w')) {
    return StartTime{};
  }
  if (whole.starts_with('+') || whole.starts_with('@')) {
    const bool after = whole.front() == '+';
    const std::string_view rest = Trim(whole.substr(1));
    if (rest.starts_with('+') || rest.starts_with('-')) return Unreadable(whole);
    if (after) {
      if (const auto clock = ParseClock(rest)) return StartTime{StartTime::Kind::kAfter, *clock};
    }
    const auto ms = ParseMs(rest);
    if (!ms) return Unreadable(whole);
    if (after && *ms > kDay) {
      return Fail(Errc::kBadValue, "found '" + std::string(whole) + "', expected at most 24 hours");
    }
    return StartTime{after ? StartTime::Kind::kAfter : StartTime::Kind::kAt, *ms};
  }
  if (const auto clock = ParseClock(whole)) return StartTime{StartTime::Kind::kWallClock, *clock};
  return Unreadable(whole);
}

std::string FormatStartTime(const StartTime& start) {
  switch (start.kind) {
    case StartTime::Kind::kNow:
      return "NOW";
    case StartTime::Kind::kAfter:
      return "+" + FormatMs(start.time);
    case StartTime::Kind::kWallClock:
      return FormatClock(start.time);
    case StartTime::Kind::kAt:
      return "@" + FormatMs(start.time);
  }
  return "NOW";
}

Time Resolve(const StartTime& start, Time now, Time wall_since_midnight) {
  switch (start.kind) {
    case StartTime::Kind::kNow:
      return now;
    case StartTime::Kind::kAfter:
      return now + start.time;
    case StartTime::Kind::kAt:
      return start.time;
    case StartTime::Kind::kWallClock:
      break;
  }
  Time delay = start.time - wall_since_midnight;
  if (delay < -kDay / 2) delay += kDay;  // just after midnight, seen from just before it
  if (delay < Time(0)) delay = delay >= -minutes(1) ? Time(0) : delay + kDay;
  return now + delay;
}

Time WallSinceMidnight() {
  const auto now = std::chrono::system_clock::now();
  const std::time_t seconds_now = std::chrono::system_clock::to_time_t(now);
  std::tm local{};
  localtime_r(&seconds_now, &local);
  const auto fraction =
      std::chrono::duration_cast<Time>(now - std::chrono::system_clock::from_time_t(seconds_now));
  return hours(local.tm_hour) + minutes(local.tm_min) + seconds(local.tm_sec) + fraction;
}

}  // namespace vm
