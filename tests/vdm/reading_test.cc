// The tables of voices and of what they read.

#include "vdm/train/reading.h"

#include <gtest/gtest.h>

#include <set>

namespace vdm {
namespace {

TEST(ReadingTest, DamageIsToldWithItsLine) {
  const auto voices = [](const char* text) { return ReadVoices("v.txt", text).error().text; };
  EXPECT_EQ(voices("# c\na flite en\n"),
            "v.txt:2: NAME ENGINE LANGUAGE SENTENCES VARIANT expected");
  EXPECT_EQ(voices("a flute en 5 -\n"), "v.txt:1: 'flute' found, flite or espeak expected");
  EXPECT_EQ(voices("a flite xx 5 -\n"), "v.txt:1: 'xx' found, en, en-gb or ja expected");
  EXPECT_EQ(voices("a flite en many -\n"), "v.txt:1: 'many' found, 0 to 10000 sentences expected");
  const auto reading = [](const char* text) { return ReadReading("r.txt", text).error().text; };
  EXPECT_EQ(reading("sentence Hello.\nspeech x\n"),
            "r.txt:2: 'speech' found, 'sentence TEXT' or 'words WORD...' expected");
  EXPECT_EQ(reading("words a b\n"), "r.txt:1: no sentences or no words found, both expected");
}

TEST(ReadingTest, AVoiceReadsTheSameEachTimeAndAnotherVoiceSomethingElse) {
  const Reading& reading = BuiltReading("en");
  std::set<std::string> texts;
  for (std::size_t n = 0; n < 100; ++n) {
    EXPECT_EQ(reading.Text(n, Dice(1)), reading.Text(n, Dice(1)));
    texts.insert(reading.Text(n, Dice(1)));
  }
  EXPECT_EQ(texts.size(), 100U);
  EXPECT_NE(reading.Text(1, Dice(1)), reading.Text(1, Dice(2)));
}

}  // namespace
}  // namespace vdm
