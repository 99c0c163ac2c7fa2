#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "fsm/motion/face_motion.h"
#include "tests/fsm/motion_support.h"

namespace fsm {
namespace {

using namespace std::chrono_literals;

/// The original's way: 14 shapes joined by sinusoids.
LipStyle Original(Language language) {
  return {.mode = LipMode::kSinusoid, .visemes = VisemeSetId::k14, .language = language};
}

TEST(VisemeTrackTest, TheKeyShapeStandsAtThePhonemesStart) {
  const auto tables = BuiltIn();
  const VisemeTrack track(List("pau 100 a 100 i 100 pau 100"), tables,
                          Original(Language::kJapanese));
  EXPECT_NEAR(track.At(100).mouth[kJawY], tables.set(VisemeSetId::k14).visemes[9].pose.mouth[kJawY],
              1e-5);
  EXPECT_NEAR(track.At(200).mouth[kJawY],
              tables.set(VisemeSetId::k14).visemes[10].pose.mouth[kJawY], 1e-5);
  EXPECT_NEAR(track.At(300).mouth[kJawY], 0, 1e-5);
}

TEST(VisemeTrackTest, BetweenKeysItIsTheOriginalsSinusoid) {
  const auto tables = BuiltIn();
  const VisemeTrack track(List("a 100 i 100"), tables, Original(Language::kJapanese));
  const double v0 = tables.set(VisemeSetId::k14).visemes[9].pose.mouth[kJawY];
  const double v1 = tables.set(VisemeSetId::k14).visemes[10].pose.mouth[kJawY];
  for (double u : {0.1, 0.25, 0.5, 0.8}) {
    const double w = std::cos(std::numbers::pi * u) / 2;
    EXPECT_NEAR(track.At(100 * u).mouth[kJawY], w * (v0 - v1) + (v0 + v1) / 2, 1e-4);
  }
}

TEST(VisemeTrackTest, ALongPhonemeHoldsAndThenMovesFor92Ms) {
  const auto tables = BuiltIn();
  const VisemeTrack track(List("a 200 i 100"), tables, Original(Language::kJapanese));
  const float full = tables.set(VisemeSetId::k14).visemes[9].pose.mouth[kJawY];
  EXPECT_FLOAT_EQ(track.At(107).mouth[kJawY], full);
  EXPECT_LT(track.At(120).mouth[kJawY], full);
  const VisemeTrack shorter(List("a 199 i 100"), tables, Original(Language::kJapanese));
  EXPECT_LT(shorter.At(60).mouth[kJawY], full);
}

TEST(VisemeTrackTest, LipClosuresSealForAFrameEvenInFastSpeech) {
  const auto tables = BuiltIn();
  for (const char* name : {"p", "b", "m"}) {
    for (int ms : {40, 60, 90, 150, 250}) {
      const vm::PhonemeList list = {
          {"a", 80ms}, {name, std::chrono::milliseconds(ms)}, {"a", 80ms}};
      const VisemeTrack track(list, tables, Original(Language::kJapanese));
      for (double t = 80; t <= 80 + 34 * 0.99; t += 1) {
        EXPECT_FLOAT_EQ(track.At(t).seal, 1) << name << " of " << ms << " at " << t;
      }
      EXPECT_FLOAT_EQ(track.At(80 + ms).seal, 0);
    }
  }
}

TEST(VisemeTrackTest, PausesAndUnknownPhonemesClose) {
  const auto tables = BuiltIn();
  const VisemeTrack track(List("a 100 pau 300 a 100 xyz 300 a 100"), tables,
                          Original(Language::kAuto));
  EXPECT_FLOAT_EQ(track.At(150).seal, 1);
  EXPECT_FLOAT_EQ(track.At(250).mouth[kJawY], 0);
  EXPECT_FLOAT_EQ(track.At(600).seal, 1);
}

TEST(VisemeTrackTest, DiphthongsGoToTheirSecondShapeAfterThirtyPerCent) {
  const auto tables = BuiltIn();
  const VisemeTrack track(List("pau 100 ay 150 pau 100"), tables, Original(Language::kAuto));
  EXPECT_NEAR(track.At(100).mouth[kJawY], tables.set(VisemeSetId::k14).visemes[9].pose.mouth[kJawY],
              1e-5);
  EXPECT_NEAR(track.At(145).mouth[kJawY],
              0.8 * tables.set(VisemeSetId::k14).visemes[10].pose.mouth[kJawY], 1e-5);
}

TEST(VisemeTrackTest, ADiphthongIsMostlyItsFirstShapeWhileSoundsOverlap) {
  const auto tables = BuiltIn();
  const VisemeTrack track(List("pau 200 ay 200 pau 200"), tables, {.language = Language::kEnglish});
  const auto jaw = [&](double ms) { return track.At(ms).mouth[kJawY]; };
  const VisemeSet& set = tables.set(VisemeSetId::k28);
  const int first = set.english.at("ay").phases[0].viseme;
  const float most = set.visemes[static_cast<std::size_t>(first)].pose.mouth[kJawY];
  EXPECT_GT(jaw(270), 0.9F * most);
  EXPECT_GT(jaw(300), 0.6F * most) << "in its middle it is still open";
  EXPECT_LT(jaw(370), 0.4F * most);
}

TEST(VisemeTrackTest, HTakesTheNextVowel) {
  const auto tables = BuiltIn();
  const VisemeTrack track(List("h 80 a 100"), tables, Original(Language::kJapanese));
  EXPECT_NEAR(track.At(0).mouth[kJawY],
              0.7 * tables.set(VisemeSetId::k14).visemes[9].pose.mouth[kJawY], 1e-5);
  EXPECT_FLOAT_EQ(track.At(0).seal, 0);
}

TEST(VisemeTrackTest, EmptyListsAndZeroDurationsAreHarmless) {
  const auto tables = BuiltIn();
  const VisemeTrack nothing({}, tables, Original(Language::kAuto));
  EXPECT_FLOAT_EQ(nothing.At(0).mouth[kJawY], 0);
  const VisemeTrack zero({{"a", 0ms}, {"h", 0ms}}, tables, Original(Language::kAuto));
  for (double t = -100; t < 10; t += 1) EXPECT_TRUE(std::isfinite(zero.At(t).mouth[kJawY]));
}

TEST(SpeechClockTest, FollowsTimeExactlyWhenTheVoiceAgrees) {
  SpeechClock clock(500ms);
  clock.Correct(1500ms, 1000, 0.25);
  EXPECT_DOUBLE_EQ(clock.PositionAt(2000ms), 1500);
  EXPECT_EQ(clock.WhenAt(1500), vm::Time(2000ms));
}

TEST(SpeechClockTest, AReportThatCameLateDoesNotHoldTheMouthBack) {
  SpeechClock clock(0ms);
  clock.Correct(1015ms, 1000, 0.25);
  clock.Correct(2012ms, 2000, 0.25);
  clock.Correct(3000ms, 3000, 0.25);  // on time: the two before were only late
  clock.Correct(4015ms, 4000, 0.25);
  EXPECT_DOUBLE_EQ(clock.PositionAt(4500ms), 4500);
}

TEST(SpeechClockTest, ThreeReportsThatAreALittleBehindAreBelievedByTheLeast) {
  SpeechClock clock(0ms);
  clock.Correct(1020ms, 1000, 0.25);
  clock.Correct(2012ms, 2000, 0.25);
  EXPECT_DOUBLE_EQ(clock.PositionAt(2900ms), 2900);
  clock.Correct(3018ms, 3000, 0.25);
  EXPECT_NEAR(clock.PositionAt(4000ms), 3988, 1e-9);
}

TEST(SpeechClockTest, WorksADifferenceOffWithoutJumpOrGoingBack) {
  for (const double voice : {880.0, 1120.0, 400.0}) {
    SpeechClock clock(0ms);
    clock.Correct(1000ms, voice, 0.25);
    double before = clock.PositionAt(1000ms);
    EXPECT_DOUBLE_EQ(before, 1000);
    for (vm::Time t = 1001ms; t < 5000ms; t += 1ms) {
      const double step = clock.PositionAt(t) - before;
      EXPECT_GE(step, 0.7499);
      EXPECT_LE(step, 1.2501);
      before = clock.PositionAt(t);
    }
    EXPECT_NEAR(clock.PositionAt(5000ms), voice + 4000, 1e-6);
    for (const double position : {0.0, 500.0, 990.0, 1005.0, 1400.0, 3000.0, 6000.0}) {
      EXPECT_NEAR(clock.PositionAt(clock.WhenAt(position)), position, 0.01);
    }
  }
}

TEST(SpeechTest, TheMouthLeadsTheVoiceByExactlyTheLead) {
  FaceMotion motion(BuiltIn(), 1);
  motion.speech.Start(0ms, List("pau 200 a 150 pau 200"), 1000ms);
  EXPECT_EQ(motion.speech.PhonemeAt(1000ms + 159ms), "pau");
  EXPECT_EQ(motion.speech.PhonemeAt(1000ms + 160ms), "a");
  const auto settings = motion.settings();
  EXPECT_DOUBLE_EQ(settings.lead_ms, 40);
  // There the vowel and the rest before it have their say by their dominance of the jaw, 1 : 0.8.
  const double full =
      FindViseme(BuiltIn().set(VisemeSetId::k28).visemes, "ja_a")->pose.mouth[kJawY] *
      settings.mouth_scale / kFullMouthScale;
  EXPECT_NEAR(motion.StateAt(1160ms).mouth[kJawY], full / 1.8, 1e-3);
  EXPECT_EQ(motion.speech.End(), vm::Time(1550ms));
}

TEST(SpeechTest, InTheOriginalsModeTheKeyShapeStandsTheLeadBeforeTheSound) {
  FaceMotion motion(BuiltIn(), 1);
  auto settings = motion.settings();
  settings.lips = Original(Language::kAuto);
  motion.Apply(0ms, settings);
  motion.speech.Start(0ms, List("pau 200 a 150 pau 200"), 1000ms);
  EXPECT_NEAR(motion.StateAt(1160ms).mouth[kJawY],
              BuiltIn().set(VisemeSetId::k14).visemes[9].pose.mouth[kJawY] * settings.mouth_scale /
                  kFullMouthScale,
              1e-4);
}

TEST(SpeechTest, OffsetDelaysTheMouth) {
  FaceMotion motion(BuiltIn(), 1);
  auto settings = motion.settings();
  settings.offset_ms = 100;
  motion.Apply(0ms, settings);
  motion.speech.Start(0ms, List("pau 200 a 150 pau 200"), 1000ms);
  EXPECT_EQ(motion.speech.PhonemeAt(1259ms), "pau");
  EXPECT_EQ(motion.speech.PhonemeAt(1260ms), "a");
  EXPECT_EQ(motion.speech.End(), vm::Time(1610ms));  // the mouth ends 60 ms after the voice
}

TEST(SpeechTest, StopClosesTheLipsWithin120MsAndSmoothly) {
  for (int at = 0; at < 900; at += 37) {
    FaceMotion motion(BuiltIn(), 1);
    ASSERT_TRUE(motion.expression.Show(0ms, "HAPPY", 1, 1, 0ms));
    motion.speech.Start(0ms, List("pau 100 a 300 o 250 a 400 pau 100"), 0ms);
    const vm::Time stop = std::chrono::milliseconds(at);
    motion.speech.Stop(stop);
    EXPECT_FALSE(motion.speech.active());
    const FaceState state = motion.StateAt(stop + 120ms);
    if (at > 60) {
      EXPECT_GT(state.seal, 0.999) << at;
    }
    EXPECT_NEAR(state.mouth[kJawY], 0, 1e-3);
    float before = motion.StateAt(stop).mouth[kJawY];
    for (vm::Time t = stop; t < stop + 600ms; t += 5ms) {
      const float now = motion.StateAt(t).mouth[kJawY];
      EXPECT_LT(std::abs(now - before), 1.6f);
      before = now;
    }
  }
}

TEST(SpeechTest, NothingJumpsFromUtteranceToUtterance) {
  FaceMotion motion(BuiltIn(), 1);
  ASSERT_TRUE(motion.expression.Show(0ms, "HAPPY", 3, 1, 0ms));
  FaceState before = motion.StateAt(0ms);
  for (vm::Time t = 0ms; t < 3000ms; t += 5ms) {
    if (t == 100ms) motion.speech.Start(t, List("a 300 o 250 a 400"), t);
    if (t == 500ms) motion.speech.Start(t, List("o 300 a 250"), t);  // interrupts
    if (t == 700ms) motion.speech.Sync(t, 320);
    if (t == 900ms) motion.speech.Stop(t);
    const FaceState now = motion.StateAt(t);
    for (std::size_t i = 0; i < kMouthParameters; ++i) {
      ASSERT_LT(std::abs(now.mouth[i] - before.mouth[i]), 1.2f) << i << " at " << t.count();
    }
    ASSERT_LT(std::abs(now.au.left[12] - before.au.left[12]), 0.12f) << t.count();
    before = now;
  }
}

TEST(SpeechTest, EmotionTintsTheMouthAndKeepsTheBrows) {
  FaceMotion motion(BuiltIn(), 1);
  ASSERT_TRUE(motion.switches().Set(0ms, "ASYMMETRY", 0));
  ASSERT_TRUE(motion.expression.Show(0ms, "SURPRISED", 1, 1, 0ms));
  motion.speech.Start(500ms, List("aa 1000"), 500ms);
  const FaceState state = motion.StateAt(1000ms);
  EXPECT_FLOAT_EQ(state.au.left[1], 1.05f);
  EXPECT_FLOAT_EQ(state.au.left[5], 0.8f);
  EXPECT_NEAR(state.au.left[26], 0.85 * 0.4, 1e-5);
  EXPECT_FLOAT_EQ(motion.StateAt(2500ms).au.left[26], 0.85f);
}

TEST(SpeechTest, MouthScaleMultipliesButClosuresStay) {
  FaceMotion motion(BuiltIn(), 1);
  auto settings = motion.settings();
  settings.mouth_scale = 15;
  motion.Apply(0ms, settings);
  motion.speech.Start(0ms, List("pau 200 a 150 m 100 a 150"), 1000ms);
  EXPECT_NEAR(motion.StateAt(1235ms).mouth[kJawY], 9 * 15.0 / 40, 0.05);
  EXPECT_FLOAT_EQ(motion.StateAt(1310ms).seal, 1);
}

TEST(SpeechTest, AtRestTheLipsAreFree) {
  FaceMotion motion(BuiltIn(), 1);
  EXPECT_FLOAT_EQ(motion.StateAt(0ms).seal, 0);
  motion.speech.Start(0ms, List("a 100"), 0ms);
  EXPECT_FLOAT_EQ(motion.StateAt(1000ms).seal, 0);
  EXPECT_FALSE(motion.NextMotion(1000ms).has_value());
}

}  // namespace
}  // namespace fsm
