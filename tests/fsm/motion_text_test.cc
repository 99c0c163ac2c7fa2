// What the words of a text do to the face that says them.

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <string>
#include <vector>

#include "fsm/motion/face_motion.h"

namespace fsm {
namespace {

using namespace std::chrono_literals;

constexpr const char* kTable =
    "look smile ALL 1 0 0 12:0.4\n"
    "look ask END -2 0 3 1:0.3 2:0.3\n"
    "cue smile hello | good day | こんにちは\n"
    "cue ask ?\n";

const MotionTables& BuiltInTables() {
  static const MotionTables tables = MotionTables::Load().value();
  return tables;
}

/// Two sentences of 1 s each, a pause of 300 ms between them.
VisemeTargets TwoSentences() {
  return MakeVisemeTargets(
      vm::ParsePhonemes("pau 100 aa 250 t 250 aa 250 t 250 pau 300 aa 250 t 250 aa 250 t 250 pau "
                        "100")
          .value(),
      BuiltInTables(), {});
}

struct Seen {
  std::string name;
  double start_ms, end_ms;
};
std::vector<Seen> Looks(const std::string& text) {
  static const TextCues cues = ReadTextCues("t", kTable, UnitNames::BuiltIn()).value();
  static const MovementNumbers gestures = MotionTables::Load()->gestures;
  std::vector<Seen> seen;
  for (const TimedLook& timed : LooksOf(cues, text, TwoSentences(), gestures)) {
    seen.push_back({timed.shown->name, timed.start_ms, timed.end_ms});
  }
  return seen;
}

TEST(TextCuesTest, ALookLastsAsLongAsTheSentenceWithTheWord) {
  const auto looks = Looks("Hello dear friend. Now we go on.");
  ASSERT_EQ(looks.size(), 1U);
  EXPECT_EQ(looks[0].name, "smile");
  EXPECT_LE(looks[0].start_ms, 0);
  EXPECT_NEAR(looks[0].end_ms, 1100, 1) << "at the pause";
}

TEST(TextCuesTest, ASecondSentenceBeginsAtThePause) {
  const auto looks = Looks("Now we go on. Hello, my friend");
  ASSERT_EQ(looks.size(), 1U);
  EXPECT_NEAR(looks[0].start_ms, 950, 1);
  EXPECT_NEAR(looks[0].end_ms, 2500, 1);
}

TEST(TextCuesTest, AQuestionIsSeenAtItsEnd) {
  const auto looks = Looks("We go on now. Are you there?");
  ASSERT_EQ(looks.size(), 1U);
  EXPECT_EQ(looks[0].name, "ask");
  EXPECT_NEAR(looks[0].start_ms, 1800, 1);
  EXPECT_NEAR(looks[0].end_ms, 2500, 1);
}

TEST(TextCuesTest, EnglishPhrasesAreWholeWordsAndOthersStandAnywhere) {
  EXPECT_TRUE(Looks("Othello is a play").empty());
  EXPECT_TRUE(Looks("hellos").empty());
  EXPECT_EQ(Looks("say \"HELLO\"").size(), 1U);
  EXPECT_EQ(Looks("a good day").size(), 1U);
  EXPECT_EQ(Looks("皆さんこんにちは。").size(), 1U);
}

TEST(TextCuesTest, MarkupIsNoText) {
  EXPECT_TRUE(Looks("<hello?/> we go").empty());
  EXPECT_EQ(Looks("<speak>hello</speak>").size(), 1U);
}

TEST(TextCuesTest, NumbersAndNoTextAreNoSentences) {
  EXPECT_EQ(Looks("It costs 3.50, hello, is that 4.20?").size(), 2U);
  EXPECT_TRUE(Looks("").empty());
  EXPECT_TRUE(Looks("?!.").empty());
}

TEST(TextCuesTest, ADamagedTableIsRefusedWithItsLine) {
  const auto error = [](const std::string& text) {
    return ReadTextCues("t", text, UnitNames::BuiltIn()).error().text;
  };
  EXPECT_EQ(error("laugh x"), "t:1: 'laugh' found, look or cue expected");
  EXPECT_EQ(error("look a SOON 0 0 0"),
            "t:1: look NAME ALL|END DOWN TURN TILT AU:WEIGHT ... expected");
  EXPECT_EQ(error("look a ALL 0 0 0\nlook a ALL 0 0 0"), "t:2: the look 'a' is here twice");
  EXPECT_NE(error("look a ALL 99 0 0").find("t:1: "), std::string::npos);
  EXPECT_NE(error("look a ALL 0 0 0 12:9").find("t:1: '9' at column 21 is no strength"),
            std::string::npos);
  EXPECT_EQ(error("cue a hello"), "t:1: no look 'a' found above");
  EXPECT_EQ(error("look a ALL 0 0 0\ncue a hello |"),
            "t:2: nothing found beside a '|', a phrase expected");
}

struct TextMotionTest : testing::Test {
  FaceMotion motion{MotionTables::Load().value(), 7};
  const vm::PhonemeList phonemes = vm::ParsePhonemes("hh 100 ax 200 l 100 ow 600").value();
  float SmileAt(vm::Time t) const { return motion.StateAt(t).au.right[12]; }
};

TEST_F(TextMotionTest, AGreetingIsFriendlyWhileItIsSaidAndNotAfterwards) {
  ASSERT_TRUE(motion.switches().Set(0ms, "TEXT", 1));
  motion.speech.Start(0ms, phonemes, 1s, "Hello!");
  EXPECT_EQ(SmileAt(500ms), 0);
  EXPECT_GT(SmileAt(1600ms), 0.1F);
  EXPECT_EQ(SmileAt(3s), 0);
  EXPECT_GT(motion.StateAt(1600ms).head_rotation[0], 0.2F);
}

TEST_F(TextMotionTest, WithoutTheWordsOrSwitchedOffNothingIsSeen) {
  motion.speech.Start(0ms, phonemes, 1s, "Hello!");
  EXPECT_EQ(SmileAt(1600ms), 0) << "TEXT is off at the start";
  motion.speech.Stop(2s);
  ASSERT_TRUE(motion.switches().Set(3s, "TEXT", 1));
  motion.speech.Start(3s, phonemes, 4s);
  EXPECT_EQ(SmileAt(4600ms), 0);
}

TEST_F(TextMotionTest, ATagSaysMoreThanWords) {
  ASSERT_TRUE(motion.switches().Set(0ms, "TEXT", 1));
  ASSERT_TRUE(motion.expression.Show(0ms, "SAD", 1, 1, 0ms));
  motion.speech.Start(0ms, phonemes, 1s, "Hello!");
  EXPECT_EQ(SmileAt(1600ms), 0);
}

TEST_F(TextMotionTest, ASpeechThatIsStoppedTakesItsLooksAway) {
  ASSERT_TRUE(motion.switches().Set(0ms, "TEXT", 1));
  motion.speech.Start(0ms, phonemes, 1s, "Hello!");
  motion.speech.Stop(1500ms);
  EXPECT_GT(SmileAt(1500ms), 0.05F);
  EXPECT_EQ(SmileAt(2s), 0);
}

}  // namespace
}  // namespace fsm
