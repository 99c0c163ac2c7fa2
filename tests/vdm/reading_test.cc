// The tables of voices and of what they read.

#include "vdm/train/reading.h"

#include <gtest/gtest.h>

#include <set>

#include "vdm/net/sound_classes.h"
#include "vdm/train/festival.h"

namespace vdm {
namespace {

TEST(ReadingTest, DamageIsToldWithItsLine) {
  const auto voices = [](const char* text) { return ReadVoices("v.txt", text).error().text; };
  EXPECT_EQ(voices("# c\na flite en\n"),
            "v.txt:2: NAME ENGINE LANGUAGE SENTENCES VARIANT expected");
  EXPECT_EQ(voices("a flute en 5 -\n"),
            "v.txt:1: 'flute' found, flite, espeak or festival expected");
  EXPECT_EQ(voices("a flite xx 5 -\n"),
            "v.txt:1: 'xx' found, one of en, en-gb, ja, it, fi, cs, ru expected");
  EXPECT_EQ(voices("a flite en many -\n"), "v.txt:1: 'many' found, 0 to 10000 sentences expected");
  const auto reading = [](const char* text) { return ReadReading("r.txt", text).error().text; };
  EXPECT_EQ(reading("sentence Hello.\nspeech x\n"),
            "r.txt:2: 'speech' found, 'sentence TEXT' or 'words WORD...' expected");
  EXPECT_EQ(reading("words a b\n"), "r.txt:1: no sentences or no words found, both expected");
}

TEST(ReadingTest, EveryVoiceHasSomethingToReadAndFestivalsHavePhones) {
  for (const TrainingVoice& voice : BuiltVoices()) {
    EXPECT_FALSE(BuiltReading(voice.language).Text(0, Dice(1)).empty()) << voice.name;
    if (voice.engine != "festival") continue;
    ASSERT_TRUE(BuiltFestivalPhones().contains(voice.language)) << voice.name;
  }
}

TEST(FestivalTest, PhonesAreReadAndDamageIsToldWithItsLine) {
  const auto error = [](const char* text) {
    return ReadFestivalPhones("f.txt", text).error().text;
  };
  EXPECT_EQ(error("# c\nen aa=aa\n"),
            "f.txt:2: 'en' found, charset or a language that has one expected");
  EXPECT_EQ(error("charset en\n"), "f.txt:1: charset LANGUAGE NAME expected");
  EXPECT_EQ(error("charset en X\nen a=b =c\n"), "f.txt:2: '=c' found, THEIRS=OURS expected");
  EXPECT_EQ(error("charset en X\nen a=b a=c\n"), "f.txt:2: 'a' stands there twice");
  const auto read = ReadFestivalPhones("f.txt", "charset fi ISO-8859-1\nfi #=pau a:=aa\n");
  ASSERT_TRUE(read);
  EXPECT_EQ(read->at("fi").charset, "ISO-8859-1");
  EXPECT_EQ(read->at("fi").phones.at("#"), "pau");
  EXPECT_EQ(read->at("fi").phones.at("a:"), "aa");
  // Every phone of ours is one that the face and the network know.
  for (const auto& [language, one] : BuiltFestivalPhones()) {
    for (const auto& [theirs, ours] : one.phones) {
      EXPECT_EQ(SoundClasses::Built().Of(ours) == 0, ours == "pau") << language << ' ' << theirs;
    }
  }
}

TEST(FestivalTest, SegmentsBecomePhonemes) {
  const FestivalLanguage language{"UTF-8", {{"#", "pau"}, {"o1", "ow"}}};
  const auto list = ReadSegments("s", "#\n0.2204 100 # \n0.3001 100 o1 \n", language);
  ASSERT_TRUE(list);
  EXPECT_EQ(vm::FormatPhonemesPlain(*list), "pau 220 ow 80");
  const auto error = [&](const char* text) {
    return ReadSegments("s", text, language).error().text;
  };
  EXPECT_EQ(error("#\n0.2 100 x\n"), "s:2: festival_phones.txt does not name the phone 'x'");
  EXPECT_EQ(error("#\nlate 100 #\n"), "s:2: 'late 100 #' found, END_S COLOUR PHONE expected");
  EXPECT_EQ(error("#\n"), "s:1: no segments found");
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
