// Where words and sentences end at the elements of SSML: in the text, and in what engines say.

#include <gtest/gtest.h>

#include <fstream>

#include "ssm/engines/open_jtalk_engine.h"
#include "ssm/flite/flite_engine.h"
#include "ssm/voice/layered_engine.h"
#include "ssm/voice/word_signs.h"
#include "ssm_stub/rule_engine.h"
#include "tests/ssm/marked_up.h"
#include "tests/support/test_data.h"
#include "vm_protocol/core/utf8.h"
#include "vm_protocol/core/xml_text.h"

namespace {

using ssm_test::Espeak;
using ssm_test::SaidBy;

const ssm::MarkupOptions kOneSound{
    .is_sound = [](const std::string& path) { return path == "good.wav"; }};

std::string PlainOf(const std::string& inside) {
  auto read = ssm::ReadMarkup("<speak version='1.1'>" + inside + "</speak>", kOneSound);
  EXPECT_TRUE(read) << inside;
  return read ? read->plain : "";
}

struct Edge {
  const char *markup, *parted;
};
// SSML 1.1, sections 1.2 and 3.1.8.2: a token does not span markup.
constexpr Edge kEnglish[] = {
    {"cup<break/>board", "cup board"},
    {"<w>cup<break/>board</w>", "cupboard"},
    {"<token>cup<emphasis>board</emphasis></token>", "cupboard"},
    {"cup<mark name='m'/>board", "cupboard"},
    {"cup<break strength='none'/>board", "cupboard"},
    {"fat<w>her</w>", "fat her"},
    {"<w>fat</w><w>her</w>", "fat her"},
    {"fat<emphasis>her</emphasis>", "fat her"},
    {"<emphasis>fat</emphasis>her", "fat her"},
    {"fat<prosody rate='fast'>her</prosody>", "fat her"},
    {"fat<voice name='slt'>her</voice>", "fat her"},
    {"fat<lang xml:lang='en'>her</lang>", "fat her"},
    {"fat<sub alias='her'>x</sub>bag", "fat her bag"},
    {"fat<audio src='bad.wav'>her</audio>", "fat her"},
    {"fat<audio src='good.wav'/>her", "fat her"},
    {"fat<unknown>her</unknown>", "fat her"},
    {"10<sub alias='kilometers'>km</sub>", "10 kilometers"},
    {"gate<say-as interpret-as='characters'>B</say-as>2", "gate B 2"},
    {"pay<say-as interpret-as='currency'>$5</say-as>", "pay $5"},
    {"un<phoneme ph='kæt'>cat</phoneme>nip", "un cat nip"},
    {"<s>hello</s><s>there</s>", "hello there"},
    {"<p>hello</p>there", "hello there"},
    {"hello<p>there</p>", "hello there"},
    {"hello <p> there </p> you", "hello there you"},
    {"<s>It is 5</s><s>30 people came</s>", "It is 5 30 people came"},
    {"<s>Stop.</s><s>(Now.)</s>", "Stop. (Now.)"},
    // What follows a word without a blank stays with it.
    {"<emphasis>cat</emphasis>, <emphasis>dog</emphasis>.", "cat, dog."},
    {"<emphasis>cat</emphasis>'s", "cat's"},
    {"\"<emphasis>cat</emphasis>\" (<w>dog</w>)", "\"cat\" (dog)"},
    {"well-<emphasis>known</emphasis>", "well-known"},
    {"cat<!-- a -->nip", "catnip"},
};

TEST(WordEdgesTest, WordsEndAtElementsAndNotAtMarks) {
  for (const Edge& edge : kEnglish) EXPECT_EQ(PlainOf(edge.markup), edge.parted) << edge.markup;
}

TEST(WordEdgesTest, ScriptsWithoutBlanksAreNotParted) {
  EXPECT_EQ(PlainOf("今日<emphasis>は</emphasis>晴れ<w>です</w>"), "今日は晴れです");
  EXPECT_EQ(PlainOf("<emphasis>Galatea</emphasis>は<w>AI</w>です"), "GalateaはAIです");
  EXPECT_EQ(PlainOf("<w>ไทย</w><w>ดี</w>"), "ไทยดี");
  EXPECT_EQ(PlainOf("<w>Привет</w><w>мир</w>"), "Привет мир");
  EXPECT_EQ(PlainOf("<s>今日は</s><s>晴れです</s>"), "今日は 晴れです");  // seen, not spoken
  EXPECT_FALSE(ssm::PartsWords(0, U'a'));
  EXPECT_FALSE(ssm::PartsWords(U'a', 0));
}

/// All of them said as if they were written with blanks, by words and phonemes.
void ExpectParted(std::unique_ptr<ssm::SpeechEngine> below, const std::string& voice) {
  ssm::LayeredEngine engine(std::move(below));
  for (const Edge& edge : kEnglish) {
    const std::string markup = edge.markup;
    // Other sounds than those of the text on purpose: letters one by one, money, sentences, files,
    // voices, pronunciations.
    if (markup.contains("say-as") || markup.contains("5</s>") || markup.contains(".wav'/>") ||
        markup.contains("name='slt'") || markup.contains("phoneme")) {
      continue;
    }
    EXPECT_EQ(SaidBy(engine, markup, voice, kOneSound), SaidBy(engine, edge.parted, voice))
        << markup;
  }
  EXPECT_NE(SaidBy(engine, "fat<w>her</w>", voice), SaidBy(engine, "father", voice));
}

TEST(WordEdgesTest, FliteSaysThemAsWords) { ExpectParted(ssm::MakeFliteEngine(), "slt"); }
TEST(WordEdgesTest, TheStubSaysThemAsWords) { ExpectParted(ssm_stub::MakeRuleEngine(), "slt"); }
TEST(WordEdgesTest, EspeakSaysThemAsWords) {
  if (!Espeak()) GTEST_SKIP() << "built without espeak-ng";
  ExpectParted(Espeak(), "espeak-en");
}

/// A sentence sounds as it does alone, whatever the next one begins with.
void ExpectSentencesApart(std::unique_ptr<ssm::SpeechEngine> below, const std::string& voice,
                          const std::vector<std::string>& sentences) {
  ssm::LayeredEngine engine(std::move(below));
  std::string sounds, words;
  for (const std::string& sentence : sentences) {
    const auto said = SaidBy(engine, sentence, voice);
    sounds += (sounds.empty() ? "" : " ") + said.sounds;
    words += (words.empty() ? "" : " ") + said.words;
  }
  const auto expect = [&](const std::string& inside) {
    const auto said = SaidBy(engine, inside, voice);
    EXPECT_EQ(said.sounds, sounds) << inside;
    EXPECT_EQ(said.words, words) << inside;
  };
  for (const std::string name : {"s", "p"}) {
    for (const std::string between : {"", " ", "<mark name='m'/>", "<break time='1s'/>"}) {
      std::string inside;
      for (const std::string& sentence : sentences) {
        inside += (inside.empty() ? "" : between) + "<" + name + ">" + sentence + "</" + name + ">";
      }
      expect(inside);
    }
  }
  expect(sentences[0] + "<s>" + sentences[1] + "</s>");
  expect("<s>" + sentences[0] + "</s>" + sentences[1]);
}

TEST(WordEdgesTest, FliteReadsEachSentenceAlone) {
  ExpectSentencesApart(ssm::MakeFliteEngine(), "slt", {"I live on King St.", "John came."});
  ExpectSentencesApart(ssm::MakeFliteEngine(), "slt", {"It is 5", "30 people came"});
}
TEST(WordEdgesTest, TheStubReadsEachSentenceAlone) {
  ExpectSentencesApart(ssm_stub::MakeRuleEngine(), "slt", {"hello", "there"});
}
TEST(WordEdgesTest, EspeakReadsEachSentenceAlone) {
  if (!Espeak()) GTEST_SKIP() << "built without espeak-ng";
  ExpectSentencesApart(Espeak(), "espeak-en", {"I live on King St.", "John came."});
  ExpectSentencesApart(Espeak(), "espeak-en", {"It is 5", "30 people came"});
#ifdef SSM_HAS_MECAB
  ExpectSentencesApart(Espeak(), "espeak-ja", {"今日は", "晴れです"});
  ExpectSentencesApart(Espeak(), "espeak-ja", {"五月三", "日本は晴れです"});
#endif
}
TEST(WordEdgesTest, VoiceFilesReadEachSentenceAlone) {
  const support::TestData voice{"an HTS voice file", "GALATEA_HTSVOICE",
                                "voices/mei/mei_normal.htsvoice"};
  if (!voice.Has()) GTEST_SKIP() << voice.Missing();
  auto engine = ssm::MakeOpenJtalkEngine({.name = "mei", .voice_file = voice.path()});
  if (!engine) GTEST_SKIP() << engine.error().text;
  ExpectSentencesApart(std::move(*engine), "mei", {"五月三", "日本は晴れです"});
}

/// Elements around every sign of 50 sentences that are of a script without blanks.
void ExpectJapaneseUncut(std::unique_ptr<ssm::SpeechEngine> below, const std::string& voice) {
  ssm::LayeredEngine engine(std::move(below));
  std::ifstream file(GALATEA_SOURCE_DIR "/tests/ssm/sentences_ja.txt");
  int sentences = 0;
  for (std::string sentence; std::getline(file, sentence); ++sentences) {
    std::string marked;
    for (std::size_t at = 0; at < sentence.size();) {
      const vm::CodePoint c = vm::SignAt(sentence, at);
      const std::string sign = vm::EscapeXml(std::string_view(sentence).substr(at, c.length));
      marked +=
          ssm::IsOfSpacedScript(c.value) ? sign : "<emphasis level='none'>" + sign + "</emphasis>";
      at += c.length;
    }
    EXPECT_EQ(SaidBy(engine, marked, voice), SaidBy(engine, vm::EscapeXml(sentence), voice))
        << marked;
  }
  EXPECT_EQ(sentences, 50);
}
TEST(WordEdgesTest, ElementsCutNoJapaneseWordOfTheStub) {
  ExpectJapaneseUncut(ssm_stub::MakeRuleEngine(), "slt");
}
TEST(WordEdgesTest, ElementsCutNoJapaneseWordOfEspeak) {
#ifdef SSM_HAS_MECAB
  if (!Espeak()) GTEST_SKIP() << "built without espeak-ng";
  ExpectJapaneseUncut(Espeak(), "espeak-ja");
#else
  GTEST_SKIP() << "built without MeCab";
#endif
}

TEST(WordEdgesTest, AMarkBetweenSentencesStandsBeforeTheirPause) {
  ssm::LayeredEngine engine(ssm::MakeFliteEngine());
  const auto plan = engine.Plan(
      ssm_test::SpansOf("<s>Hello</s><mark name='m'/><s>there</s>", "slt"), ssm_test::kNever);
  ASSERT_TRUE(plan);
  ASSERT_EQ(plan->marks.size(), 1u);
  EXPECT_EQ(plan->words[1].start - plan->marks[0].at, ssm::Millis(200));
}

}  // namespace
