// When samples were heard, whatever their arrival is like.

#include "vdm/mouth/sound_clock.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace vdm {
namespace {

using namespace std::chrono_literals;
using std::chrono::microseconds;
using Places = SoundClock::Places;

TEST(SoundClockTest, SoundAtThePaceOfTimeIsExact) {
  SoundClock clock;
  EXPECT_FALSE(clock.End());
  for (int piece = 1; piece <= 1000; ++piece) {
    EXPECT_EQ(clock.Add(5s + piece * 20ms, 320) == Places::kBeginAnew, piece == 1);
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
  for (int piece = 0; piece < 100; ++piece)
    EXPECT_EQ(clock.Add(1s + piece * 1ms, 320), Places::kGoOn);
  EXPECT_NEAR(static_cast<double>(clock.End()->count()), 3e6, 1e3);
}

TEST(SoundClockTest, AfterAHoleItBeginsAnew) {
  SoundClock clock;
  clock.Add(1s, 320);
  EXPECT_EQ(clock.Add(5s, 320), Places::kBeginAnew);
  EXPECT_EQ(clock.End(), 5s);
}

/// Pieces of 20 ms at their time up to 1 s; those of `hole` then come all at once; then the rest at
/// their time. The last sample's time at 4 s, less 4 s.
vm::Time AfterLateSound(vm::Time hole, bool sent_later = true) {
  SoundClock clock;
  for (int piece = 1; piece <= 200; ++piece) {
    const vm::Time due = piece * 20ms;
    const bool in_hole = due > 1s && due <= 1s + hole;
    if (in_hole && !sent_later) continue;
    clock.Add(in_hole ? 1s + hole + microseconds(piece) : due, 320);
  }
  return *clock.End() - 4s;
}

TEST(SoundClockTest, SoundThatCameLateIsWhereItWouldHaveBeenInTime) {
  for (const vm::Time hole : {vm::Time(60ms), vm::Time(140ms), vm::Time(500ms), vm::Time(900ms)}) {
    EXPECT_LE(abs(AfterLateSound(hole)), 45ms) << hole.count();
  }
}

TEST(SoundClockTest, APauseThatNobodyMakesUpForStaysOne) {
  for (const vm::Time hole : {vm::Time(140ms), vm::Time(500ms), vm::Time(900ms)}) {
    EXPECT_LE(abs(AfterLateSound(hole, false)), 1ms) << hole.count();
  }
}

TEST(SoundClockTest, ASentenceSentAtOnceAfterAPauseIsPlayedFromItsBeginning) {
  SoundClock clock;
  for (int piece = 1; piece <= 50; ++piece) clock.Add(piece * 20ms, 320);
  for (int piece = 1; piece <= 100; ++piece) clock.Add(2s + piece * 1ms, 320);
  EXPECT_LE(abs(*clock.End() - 3981ms), 2ms);
}

TEST(SoundClockTest, HolesOneSoonAfterTheOtherAreMadeUpForTogether) {
  SoundClock clock;
  std::vector<vm::Time> arrivals;
  for (int piece = 1; piece <= 300; ++piece) {
    vm::Time at = piece * 20ms;
    if (at > 1s && at <= 1200ms) at = 1200ms;
    if (at > 1240ms && at <= 1600ms) at = 1600ms;
    arrivals.push_back(at + microseconds(piece));
  }
  for (const vm::Time at : arrivals) clock.Add(at, 320);
  EXPECT_LE(abs(*clock.End() - 6s), 45ms);
}

}  // namespace
}  // namespace vdm
