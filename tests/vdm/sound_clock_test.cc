// When samples were heard, whatever their arrival is like.

#include "vdm/mouth/sound_clock.h"

#include <gtest/gtest.h>

#include <random>

namespace vdm {
namespace {

using namespace std::chrono_literals;
using std::chrono::microseconds;

TEST(SoundClockTest, SoundAtThePaceOfTimeIsExact) {
  SoundClock clock;
  EXPECT_FALSE(clock.End());
  for (int piece = 1; piece <= 1000; ++piece) {
    EXPECT_EQ(clock.Add(5s + piece * 20ms, 320), piece == 1);
    EXPECT_EQ(clock.TimeOf(0), 5s);
    EXPECT_EQ(clock.End(), 5s + piece * 20ms);
  }
}

TEST(SoundClockTest, ShakyArrivalMovesPlacesByNoMoreThanSome) {
  SoundClock clock;
  std::mt19937 random(1);
  std::uniform_int_distribution<int> late_us(0, 30'000);
  for (int piece = 1; piece <= 3000; ++piece) {
    clock.Add(piece * 20ms + microseconds(late_us(random)), 320);
    const auto off = clock.TimeOf(0);
    EXPECT_LE(off, 35ms);
    EXPECT_GE(off, -5ms);
  }
}

TEST(SoundClockTest, ADriftingSourceIsFollowed) {
  SoundClock clock;  // its second lasts 1.0002 of ours, for an hour
  for (int piece = 1; piece <= 180'000; ++piece) clock.Add(piece * microseconds(20'004), 320);
  EXPECT_LT(abs(*clock.End() - 180'000 * microseconds(20'004)), 1ms);
}

TEST(SoundClockTest, SoundFasterThanTimeIsAhead) {
  SoundClock clock;
  clock.Add(1s, 320);
  for (int piece = 0; piece < 100; ++piece) EXPECT_FALSE(clock.Add(1s + piece * 1ms, 320));
  EXPECT_NEAR(static_cast<double>(clock.End()->count()), 3e6, 1e3);
}

TEST(SoundClockTest, AfterAHoleItBeginsAnew) {
  SoundClock clock;
  clock.Add(1s, 320);
  EXPECT_TRUE(clock.Add(5s, 320));
  EXPECT_EQ(clock.End(), 5s);
}

}  // namespace
}  // namespace vdm
