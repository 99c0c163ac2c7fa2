#include "vm_protocol/core/start_time.h"

#include <gtest/gtest.h>

namespace vm {
namespace {

using std::chrono::hours;
using std::chrono::milliseconds;
using std::chrono::minutes;
using std::chrono::seconds;
using Kind = StartTime::Kind;

TEST(StartTimeTest, ReadsEveryForm) {
  EXPECT_EQ(ParseStartTime("NOW"), (StartTime{Kind::kNow, Time(0)}));
  EXPECT_EQ(ParseStartTime("now"), (StartTime{Kind::kNow, Time(0)}));
  EXPECT_EQ(ParseStartTime("+500"), (StartTime{Kind::kAfter, milliseconds(500)}));
  EXPECT_EQ(ParseStartTime("+ 500"), (StartTime{Kind::kAfter, milliseconds(500)}));
  EXPECT_EQ(ParseStartTime("+00:00:01.250"), (StartTime{Kind::kAfter, milliseconds(1250)}));
  EXPECT_EQ(ParseStartTime("@1234.5"), (StartTime{Kind::kAt, Time(1234500)}));
  EXPECT_EQ(ParseStartTime("23:59:59.5"),
            (StartTime{Kind::kWallClock, hours(24) - milliseconds(500)}));
}

TEST(StartTimeTest, RefusesEverythingElse) {
  for (const auto* text : {"", "NOWW", "500", "-500", "+-5", "@", "+nan", "24:00:00", "12:60:00",
                           "1:00:00", "12:00:00.", "12:00:00.1234567", "+86400001", "@inf"}) {
    EXPECT_FALSE(ParseStartTime(text)) << text;
  }
}

TEST(StartTimeTest, FormattingReadsBack) {
  for (const auto* text : {"NOW", "+500", "@1234.5", "12:34:56.789"}) {
    EXPECT_EQ(FormatStartTime(*ParseStartTime(text)), text);
  }
}

TEST(StartTimeTest, ResolvesOnTheGivenClock) {
  const Time now = seconds(100);
  EXPECT_EQ(Resolve(*ParseStartTime("NOW"), now, hours(12)), now);
  EXPECT_EQ(Resolve(*ParseStartTime("+250"), now, hours(12)), now + milliseconds(250));
  EXPECT_EQ(Resolve(*ParseStartTime("@7"), now, hours(12)), milliseconds(7));
  EXPECT_EQ(Resolve(*ParseStartTime("12:00:05"), now, hours(12)), now + seconds(5));
}

TEST(StartTimeTest, AWallTimeJustPastIsNowAndOneLongPastIsTomorrow) {
  const Time now = seconds(100);
  EXPECT_EQ(Resolve(*ParseStartTime("12:00:00"), now, hours(12) + seconds(30)), now);
  EXPECT_EQ(Resolve(*ParseStartTime("12:00:00"), now, hours(12) + minutes(2)),
            now + hours(24) - minutes(2));
  EXPECT_EQ(Resolve(*ParseStartTime("00:00:01"), now, hours(24) - seconds(1)), now + seconds(2));
}

}  // namespace
}  // namespace vm
