// What a face does without being told to: onsets, asymmetry, blinks, gaze, gestures of speech.

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <vector>

#include "fsm/base/random.h"
#include "fsm/motion/face_motion.h"
#include "fsm/motion/idle_behaviour.h"
#include "fsm/motion/inputs/idle_kinds.h"
#include "tests/fsm/motion_support.h"

namespace fsm {
namespace {

using namespace std::chrono_literals;

constexpr const char* kSentence =
    "pau 200 hh 60 ax 50 l 60 ow 180 pau 180 m 70 ay 140 n 60 ey 170 m 80 ih 60 z 90 g 70 ae 160 "
    "l 60 ax 50 t 60 iy 110 ah 60 pau 200 hh 60 aw 190 aa 60 r 60 y 50 uw 180 pau 200";

struct IdleBehaviourTest : testing::Test {
  FaceMotion motion{MotionTables::Load().value(), 7};
  void On(const char* kind, int pattern = 1) {
    ASSERT_TRUE(motion.switches().Set(0ms, kind, pattern)) << kind;
  }
  float Nod(vm::Time t) { return motion.StateAt(t).head_rotation[0]; }
};

TEST_F(IdleBehaviourTest, NothingMovesUntilItIsSwitchedOn) {
  EXPECT_FALSE(motion.NextMotion(0ms).has_value());
  motion.speech.Start(0ms, List(kSentence), 1s);
  for (vm::Time t = 0ms; t < 6s; t += 40ms) {
    const FaceState state = motion.StateAt(t);
    ASSERT_EQ(state.head_rotation, (std::array<float, 3>{}));
    ASSERT_EQ(state.blink.left, 0);
    ASSERT_EQ(state.au.left[1], 0);
    ASSERT_EQ(state.gaze.left[kDown], 0);
  }
}

TEST_F(IdleBehaviourTest, AProfileTakesTheLastPatternWhereTheTablesHaveFewer) {
  MotionTables tables = MotionTables::Load().value();
  tables.motions.auto_blinks.resize(1);
  tables.motions.auto_moves.resize(1);
  FaceMotion few(tables, 7);
  ASSERT_TRUE(few.switches().SetProfile(0ms, "LIVELY"));
  EXPECT_EQ(few.switches()[IdleKind::kMove].pattern, 1U);
  EXPECT_EQ(few.switches()[IdleKind::kBlink].pattern, 1U);
  for (vm::Time t = 0ms; t < 20s; t += 500ms) few.StateAt(t);
}

// Each value of what idle behaviour moves.
std::vector<float> Moved(const FaceState& state) {
  std::vector<float> all(state.head_rotation.begin(), state.head_rotation.end());
  for (const Side side : kSides) {
    all.insert(all.end(), state.au[side].begin(), state.au[side].end());
    all.insert(all.end(), state.gaze[side].begin(), state.gaze[side].end());
    all.push_back(state.blink[side]);
  }
  return all;
}

TEST_F(IdleBehaviourTest, APatternThatReplacesAnotherFadesInWhileThatFadesOut) {
  // By kind, the most that a value changes in a millisecond; saccades are fast.
  for (const auto& [kind, most] : {std::pair{"MOVE", 0.01F},
                                   {"GAZE", 0.6F},
                                   {"BREATH", 0.01F},
                                   {"NODS", 0.05F},
                                   {"FACE", 0.01F}}) {
    FaceMotion face(MotionTables::Load().value(), 7);
    ASSERT_TRUE(face.switches().Set(0ms, kind, 1));
    const auto before = Moved(face.StateAt(10300ms)), earlier = Moved(face.StateAt(10100ms));
    ASSERT_TRUE(face.switches().Set(10300ms, kind, 2));
    EXPECT_EQ(Moved(face.StateAt(10100ms)), earlier) << kind << ": the past is what it was";
    auto last = before;
    for (vm::Time t = 10300ms; t < 12s; t += 1ms) {
      const auto now = Moved(face.StateAt(t));
      for (std::size_t i = 0; i < now.size(); ++i) {
        ASSERT_NEAR(now[i], last[i], most)
            << kind << " value " << i << " at " << t.count() << " us";
      }
      last = now;
    }
    // Once it has faded, only the new one is seen.
    FaceMotion only(MotionTables::Load().value(), 7);
    ASSERT_TRUE(only.switches().Set(10300ms, kind, 2));
    EXPECT_EQ(Moved(only.StateAt(20s)), Moved(face.StateAt(20s))) << kind;
  }
}

TEST_F(IdleBehaviourTest, OnsetsAreSlowFastSlow) {
  ASSERT_TRUE(motion.expression.Show(0ms, "HAPPY", 1, 1, 0ms));
  const auto smile = [&](double part) {
    return motion.StateAt(FromMs(556 * part)).au.right[12] / motion.StateAt(2s).au.right[12];
  };
  EXPECT_LT(smile(0.2), 0.1);
  EXPECT_NEAR(smile(0.53), 0.5, 0.12);
  EXPECT_GT(smile(0.85), 0.9);
}

TEST_F(IdleBehaviourTest, FeltExpressionsTakeTheElicitedTimes) {
  auto settings = motion.settings();
  settings.onset = Onset::kElicited;
  motion.Apply(0ms, settings);
  ASSERT_TRUE(motion.expression.Show(0ms, "SURPRISED", 1, 1, 0ms));
  EXPECT_EQ(motion.SettledAt(0ms), vm::Time(228ms));
  ASSERT_TRUE(motion.expression.Show(1s, "HAPPY", 1, 1, 0ms));
  EXPECT_EQ(motion.SettledAt(1s), vm::Time(1724ms));
}

TEST_F(IdleBehaviourTest, OneSideBeginsALittleLaterAlwaysTheSame) {
  const auto ahead = [](FaceMotion& face) {
    EXPECT_TRUE(face.expression.Show(0ms, "HAPPY", 1, 1, 0ms));
    const FaceState early = face.StateAt(200ms);
    EXPECT_EQ(face.StateAt(2s).au.left[12], face.StateAt(2s).au.right[12]);
    return early.au.left[12] - early.au.right[12];
  };
  const float first = ahead(motion);
  EXPECT_NE(first, 0);
  EXPECT_LT(std::abs(first), 0.1f);
  FaceMotion same(MotionTables::Load().value(), 7);
  EXPECT_EQ(ahead(same), first);
  bool other_side = false;
  for (std::uint64_t person = 1; person < 9; ++person) {
    FaceMotion other(MotionTables::Load().value(), 7);
    other.expression.SetPerson(person);
    other_side = other_side || ahead(other) * first < 0;
  }
  EXPECT_TRUE(other_side);
  ASSERT_TRUE(same.switches().Set(3s, "ASYMMETRY", 0));
  same.expression.Neutral(3s);
  ASSERT_TRUE(same.expression.Show(5s, "HAPPY", 1, 1, 0ms));
  EXPECT_EQ(same.StateAt(5200ms).au.left[12], same.StateAt(5200ms).au.right[12]);
}

TEST_F(IdleBehaviourTest, LidsCloseFasterThanTheyOpen) {
  for (const BlinkPattern& blink : motion.tables().motions.blinks) {
    EXPECT_LT(blink.closing_ms, 0.75 * blink.opening_ms);
  }
}

TEST_F(IdleBehaviourTest, BlinkIntervalsAreSkewedAndSeeded) {
  On("BLINK");
  std::vector<double> intervals;
  double last = -1;
  bool shut = false;
  for (vm::Time t = 0ms; t < 600s; t += 20ms) {
    const bool now = motion.StateAt(t).blink.left > 0.3f;
    if (now && !shut && last >= 0) intervals.push_back(InMs(t) - last);
    if (now && !shut) last = InMs(t);
    shut = now;
  }
  std::ranges::sort(intervals);
  ASSERT_GT(intervals.size(), 120u);
  EXPECT_GE(intervals.front(), 1950);
  EXPECT_LE(intervals.back(), 6050);
  double mean = 0;
  for (const double ms : intervals) mean += ms / static_cast<double>(intervals.size());
  EXPECT_NEAR(mean, 4000, 500);
  EXPECT_LT(intervals[intervals.size() / 2], mean) << "the median is below the mean";
}

TEST_F(IdleBehaviourTest, LargeShiftsOfTheGazeComeWithABlinkWhichCanBeSwitchedOff) {
  motion.eyes.Gaze(0ms, {0, 30}, 0ms);
  EXPECT_EQ(motion.StateAt(90ms).blink.left, 0);
  On("GAZEBLINK");
  int blinks = 0;
  for (int i = 1; i <= 20; ++i) {
    const vm::Time at = i * 2s;
    motion.eyes.Gaze(at, {0, i % 2 == 0 ? 20.0f : -20.0f}, 0ms);
    if (motion.StateAt(at + 90ms).blink.left > 0.5f) ++blinks;
  }
  EXPECT_GE(blinks, 16);
}

TEST_F(IdleBehaviourTest, MostUtterancesEndWithABlink) {
  On("ENDBLINK");
  int blinks = 0;
  for (int i = 0; i < 20; ++i) {
    const vm::Time at = i * 10s;
    motion.speech.Start(at, List("pau 100 aa 300 pau 100"), at);
    EXPECT_EQ(motion.StateAt(at + 250ms).blink.left, 0);
    float shut = 0;
    for (vm::Time t = at + 400ms; t < at + 900ms; t += 10ms) {
      shut = std::max(shut, motion.StateAt(t).blink.left);
    }
    if (shut > 0.9f) ++blinks;
  }
  EXPECT_GE(blinks, 12);
  EXPECT_LE(blinks, 19);
}

TEST_F(IdleBehaviourTest, TheEyesStayOnTheUserWhileTheHeadMoves) {
  motion.eyes.GazeAtUser(0ms);
  motion.head.TurnTo(100ms, {5, 20, 0});
  const FaceState state = motion.StateAt(2s);
  EXPECT_FLOAT_EQ(state.head_rotation[1], 20);
  EXPECT_NEAR((state.gaze.left[kToRight] + state.gaze.right[kToRight]) / 2, -20, 1e-3);
  EXPECT_NEAR(state.gaze.left[kDown], -5, 1e-3);  // up, as the head went down
}

TEST_F(IdleBehaviourTest, TheEyesConvergeOnWhatIsNear) {
  motion.eyes.GazeAtUser(0ms);
  const FaceState state = motion.StateAt(1s);
  // The agent's left eye is on the viewer's right: converging, it turns to the viewer's left.
  EXPECT_NEAR(state.gaze.left[kToRight], -2.54, 0.02);
  EXPECT_NEAR(state.gaze.right[kToRight], 2.54, 0.02);
  auto settings = motion.settings();
  settings.gaze_distance_mm = 0;
  motion.Apply(1s, settings);
  motion.eyes.GazeAtUser(1s);
  EXPECT_NEAR(motion.StateAt(2s).gaze.left[kToRight], 0, 1e-3);
}

TEST_F(IdleBehaviourTest, AThinkerLooksAwayHereAndThereUntilTheNextGaze) {
  motion.eyes.GazeAtUser(0ms);
  motion.eyes.Think(1s);
  float least = 90;
  std::vector<float> seen;
  for (vm::Time t = 1200ms; t < 12s; t += 100ms) {
    const FaceState state = motion.StateAt(t);
    least = std::min(least, std::hypot(state.gaze.left[kDown], state.gaze.left[kToRight]));
    if (seen.empty() || std::abs(seen.back() - state.gaze.left[kDown]) > 0.5f) {
      seen.push_back(state.gaze.left[kDown]);
    }
  }
  EXPECT_GT(least, 5);
  EXPECT_GE(seen.size(), 4u);
  motion.eyes.GazeAtUser(12s);
  EXPECT_NEAR(motion.StateAt(13s).gaze.left[kDown], 0, 0.01);
  EXPECT_FALSE(motion.NextMotion(13s).has_value());
}

TEST_F(IdleBehaviourTest, HeadAndBrowsMoveWithTheStressAndComeToRest) {
  On("SPEECH");
  motion.speech.Start(0ms, List(kSentence), 1s);
  float most = 0, least = 0, brow = 0, before = 0;
  int nods = 0;
  bool down = false;
  for (vm::Time t = 0ms; t < 8s; t += 10ms) {
    const FaceState state = motion.StateAt(t);
    const float nod = state.head_rotation[0];
    EXPECT_LT(std::abs(nod - before), 0.45f) << "no jumps, " << t.count();
    before = nod;
    most = std::max(most, nod);
    least = std::min(least, nod);
    brow = std::max(brow, state.au.left[1]);
    if (nod > 0.6f && !down) ++nods;
    down = nod > (down ? -0.1f : 0.6f);
  }
  EXPECT_GT(most, 1.5f);
  EXPECT_LT(most, 5);
  EXPECT_LT(least, -0.2f);
  EXPECT_GE(nods, 3);
  EXPECT_LE(nods, 9);
  EXPECT_GT(brow, 0.1f);
  EXPECT_FLOAT_EQ(Nod(8s), 0);
  EXPECT_FALSE(motion.NextMotion(8s).has_value());
}

TEST_F(IdleBehaviourTest, NodsFallOnStressedVowels) {
  On("SPEECH");
  motion.speech.Start(
      0ms, List("pau 200 t 60 ax 40 t 60 ax 40 t 60 aa 220 t 60 ax 40 t 60 ax 40 pau 200"), 1s);
  vm::Time peak{0};
  for (vm::Time t = 1s; t < 2s; t += 5ms) {
    if (Nod(t) > Nod(peak)) peak = t;
  }
  // The vowel is at 460 to 680 ms of the mouth, which leads by 40.
  EXPECT_NEAR(InMs(peak) - 960, 548, 60);
}

TEST_F(IdleBehaviourTest, SpeakersLookAwayAtTheBeginningAndBackBeforeTheEnd) {
  On("AVERT");
  motion.speech.Start(0ms, List(kSentence), 1s);
  float away = 0;
  for (vm::Time t = 1s; t < 2s; t += 20ms) {
    away = std::max(away, std::abs(motion.StateAt(t).gaze.left[kToRight]));
  }
  EXPECT_GT(away, 5);
  for (vm::Time t = 3s; t < 5s; t += 20ms)
    EXPECT_NEAR(motion.StateAt(t).gaze.left[kToRight], 0, 0.01);
  motion.speech.Start(10s, List("pau 100 y 60 eh 120 s 150"), 10s);  // too short for that
  for (vm::Time t = 10s; t < 11s; t += 20ms)
    EXPECT_NEAR(motion.StateAt(t).gaze.left[kToRight], 0, 0.01);
}

TEST_F(IdleBehaviourTest, BreathMovesTheHeadALittleAboutFifteenTimesAMinute) {
  On("BREATH");
  int breaths = 0;
  bool in = false;
  for (vm::Time t = 1s; t < 61s; t += 50ms) {
    EXPECT_LE(std::abs(Nod(t)), 0.46f);
    const bool now = Nod(t) < -0.25f;
    if (now && !in) ++breaths;
    in = now;
  }
  EXPECT_NEAR(breaths, 15, 1);
}

TEST_F(IdleBehaviourTest, AListenerNodsButNotWhileSpeaking) {
  On("NODS");
  float most = 0;
  for (vm::Time t = 0ms; t < 30s; t += 20ms) most = std::max(most, Nod(t));
  EXPECT_GT(most, 2);
  motion.speech.Start(30s, List("pau 20000"), 30s);
  for (vm::Time t = 31s; t < 49s; t += 20ms) EXPECT_LT(Nod(t), 0.01f);
}

TEST_F(IdleBehaviourTest, GesturesHaveStrengthAndCount) {
  ASSERT_TRUE(motion.PlayMovement(0ms, "NOD", 1, 0.5, 3));
  EXPECT_NEAR(Nod(100ms), 5, 1e-3);
  EXPECT_NEAR(Nod(300ms), 5 * 0.85, 1e-3);
  EXPECT_NEAR(Nod(500ms), 5 * 0.85 * 0.85, 1e-3);
  EXPECT_FLOAT_EQ(Nod(600ms), 0);
  EXPECT_EQ(motion.EndsAt(0ms), vm::Time(600ms));
  ASSERT_TRUE(motion.PlayMovement(1s, "SHAKE", 4));
  EXPECT_GT(motion.StateAt(1180ms).head_rotation[1], 7);
  ASSERT_TRUE(motion.PlayMovement(5s, "TILT", 4));
  EXPECT_GT(motion.StateAt(6s).head_rotation[2], 8);
  EXPECT_FALSE(motion.PlayMovement(5s, "NOD", 1, std::nan(""), 1));
  EXPECT_FALSE(motion.PlayMovement(5s, "NOD", 1, 1, 1000));
}

TEST_F(IdleBehaviourTest, ProfilesSwitchEverythingAtOnceAndPartsRemainSwitchable) {
  for (const char* profile : {"CALM", "LIVELY", "LISTENING", "STILL"}) {
    ASSERT_TRUE(motion.switches().SetProfile(0ms, profile)) << profile;
    EXPECT_TRUE(motion.NextMotion(10s).has_value());
  }
  ASSERT_TRUE(motion.switches().SetProfile(0ms, "LISTENING"));
  EXPECT_GT(motion.StateAt(2s).au.left[12], 0.05f) << "friendly";
  for (const IdleKindRow& row : IdleKinds()) {
    ASSERT_TRUE(motion.switches().Set(3s, row.name, 0)) << row.name;
  }
  EXPECT_FALSE(motion.NextMotion(10s).has_value());
  const FaceState state = motion.StateAt(10s);
  EXPECT_EQ(state.head_rotation, (std::array<float, 3>{}));
  EXPECT_EQ(state.au.left[12], 0);
  EXPECT_FALSE(motion.switches().SetProfile(10s, "PARTY"));
}

TEST_F(IdleBehaviourTest, WhoLivesLooksFriendlyUntilAnExpressionIsCommanded) {
  ASSERT_TRUE(motion.switches().SetProfile(0ms, "CALM"));
  EXPECT_GT(motion.StateAt(2s).au.left[12], 0.1f);
  EXPECT_GT(motion.StateAt(2s).au.left[6], 0.1f);
  ASSERT_TRUE(motion.expression.Show(3s, "SAD", 1, 1, 0ms));
  EXPECT_EQ(motion.StateAt(6s).au.left[12], 0);
}

TEST_F(IdleBehaviourTest, TheSameSeedLivesTheSameLife) {
  FaceMotion same(MotionTables::Load().value(), 7);
  FaceMotion other(MotionTables::Load().value(), 8);
  for (FaceMotion* face : {&motion, &same, &other}) {
    ASSERT_TRUE(face->switches().SetProfile(0ms, "LIVELY"));
    face->eyes.GazeAtUser(0ms);
    face->speech.Start(1s, List(kSentence), 2s);
  }
  bool differs = false;
  for (vm::Time t = 0ms; t < 20s; t += 100ms) {
    const FaceState a = motion.StateAt(t), b = same.StateAt(t), c = other.StateAt(t);
    ASSERT_EQ(a.head_rotation, b.head_rotation);
    ASSERT_EQ(a.blink.left, b.blink.left);
    ASSERT_EQ(a.gaze.left[kToRight], b.gaze.left[kToRight]);
    differs = differs || a.head_rotation != c.head_rotation;
  }
  EXPECT_TRUE(differs);
}

struct BlinkTest : testing::Test {
  static constexpr std::uint64_t kSeed = 7;
  static constexpr vm::Time kSwitched = 1234ms;
  MotionInputs inputs{MotionTables::Load().value(), kSeed};

  BlinkTest() { EXPECT_TRUE(inputs.switches.Set(kSwitched, "BLINK", 1)); }
  /// When the first blinks begin: their intervals, each drawn by its number, added up one after the
  /// other.
  std::vector<vm::Time> Starts(std::int64_t count) const {
    constexpr std::uint64_t kStream = 0;
    const double mean = inputs.tables.motions.auto_blinks[0].interval_ms;
    const auto& row = inputs.tables.gestures.blink;
    std::vector<vm::Time> starts;
    for (std::int64_t k = 0; k < count; ++k) {
      double normal = 0;
      for (const std::int64_t n : {3 * k, 3 * k + 1, 3 * k + 2}) {
        normal += RandomAt(kSeed, kStream, n);
      }
      const double ms = mean * std::clamp(row.median * std::exp(row.log_spread * normal),
                                          double{row.shortest}, double{row.longest});
      const vm::Time before = starts.empty() ? kSwitched : starts.back();
      starts.push_back(before + FromMs(starts.empty() ? row.first * ms : ms));
    }
    return starts;
  }
};

TEST_F(BlinkTest, BlinksAreTheSumOfTheirIntervalsInWhateverOrderTheyAreAskedFor) {
  constexpr std::int64_t kCount = 2000;
  const std::vector<vm::Time> starts = Starts(kCount);
  const IdleBehaviour forward{inputs}, back{inputs}, jumping{inputs};
  const auto check = [&](const IdleBehaviour& autonomy, std::size_t k) {
    const vm::Time start = starts[k];
    // Long after the blink before, which takes no more than a quarter of a second.
    ASSERT_EQ(autonomy.NextMotion(start - 1ms), start) << k;
    ASSERT_EQ(autonomy.BlinkAt(start - 1ms), 0) << k;
    ASSERT_EQ(autonomy.NextMotion(start + 90ms), start + 90ms) << k;
    ASSERT_GE(autonomy.BlinkAt(start + 90ms), 0.7) << k;
  };
  for (std::size_t k = 0; k < kCount; ++k) {
    check(forward, k);
    check(back, kCount - 1 - k);
    check(jumping, k * 887 % kCount);
  }
  EXPECT_EQ(forward.BlinkAt(0ms), 0) << "before the switch";
  EXPECT_EQ(forward.NextMotion(kSwitched + 100ms), starts[0]);
}

TEST_F(BlinkTest, TheNextBlinkIsFoundAsFastAfterWeeksAsAtTheStart) {
  using Clock = std::chrono::steady_clock;
  const IdleBehaviour autonomy{inputs};
  const auto took = [&](vm::Time from) {
    (void)autonomy.NextMotion(from);  // goes there
    const auto begin = Clock::now();
    for (int i = 0; i < 5000; ++i) (void)autonomy.NextMotion(from + i * 20ms);
    return Clock::now() - begin;
  };
  const auto at_first = took(10s), later = took(std::chrono::hours(24 * 21));
  // 450,000 blinks later. A shared machine may take its time for either.
  EXPECT_LT(later, 20 * at_first + 100ms);
}

}  // namespace
}  // namespace fsm
