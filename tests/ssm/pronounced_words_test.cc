// Words with a pronunciation of their own beside letters, signs and each other.

#include <gtest/gtest.h>

#include "ssm/flite/flite_engine.h"
#include "ssm/voice/layered_engine.h"
#include "ssm/voice/pronounced_text.h"
#include "tests/ssm/marked_up.h"

namespace {

using ssm_test::Espeak;
using ssm_test::SaidBy;

const std::string kCat = "<phoneme ph='kæt'>cat</phoneme>";
const std::string kDog = "<phoneme ph='dɔɡ'>dog</phoneme>";

TEST(PronouncedWordsTest, LettersBesideOneArePartedFromItsName) {
  const std::string cat = ssm::Pronounced("kæt", "cat");
  const auto text = [](const std::string& written) { return ssm::NamePronounced(written).text; };
  EXPECT_EQ(text("a " + cat + "s b"), "a zabobova s b");
  EXPECT_EQ(text("un" + cat), "un zabobova");
  EXPECT_EQ(text("5" + cat + "é"), "5 zabobova é");
  EXPECT_EQ(text(cat + cat), "zabobova zadobova");
  EXPECT_EQ(text("(\"" + cat + "\"), " + cat + "'s " + cat + "-like"),
            "(\"zabobova\"), zadobova's zafobova-like");
}

/// The sounds are where they belong, whatever stands beside the word.
void ExpectPronounced(std::unique_ptr<ssm::SpeechEngine> below, const std::string& voice) {
  ssm::LayeredEngine engine(std::move(below));
  const auto sounds = [&](const std::string& inside) {
    return SaidBy(engine, inside, voice).sounds;
  };
  EXPECT_EQ(sounds(kCat), "k ae t");
  EXPECT_EQ(sounds("\"" + kCat + "\" sat"), "k ae t s ae t");
  EXPECT_EQ(sounds("(" + kCat + ") sat"), "k ae t s ae t");
  EXPECT_EQ(sounds("“" + kCat + "” sat"), "k ae t s ae t");
  EXPECT_TRUE(sounds(kCat + "s sat.").starts_with("k ae t eh s s ae t"));
  EXPECT_EQ(sounds(kCat + kDog), "k ae t d ao g");
  EXPECT_EQ(sounds(kCat + "<mark name='m'/>" + kDog), "k ae t d ao g");
  EXPECT_EQ(sounds(kCat + "<mark name='m'/>nip"), "k ae t n ih p");
  EXPECT_EQ(sounds("<w>" + kCat + "nip</w>"), "k ae t n ih p");
  EXPECT_EQ(sounds("<sub alias='sad'>x</sub>" + kCat), "s ae d k ae t");
  EXPECT_EQ(sounds("sad" + kCat), "s ae d k ae t");
  const auto said = SaidBy(engine, "sad " + kCat + "nip", voice);
  EXPECT_EQ(said.words, "sad cat nip");
}

TEST(PronouncedWordsTest, FliteSaysThemBesideAnything) {
  ExpectPronounced(ssm::MakeFliteEngine(), "slt");
}

TEST(PronouncedWordsTest, EspeakSaysThemBesideAnything) {
  if (!Espeak()) GTEST_SKIP() << "built without espeak-ng";
  ExpectPronounced(Espeak(), "espeak-en");
}

}  // namespace
