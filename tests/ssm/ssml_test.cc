#include "ssm/voice/ssml.h"

#include <gtest/gtest.h>

#include "ssm/voice/emotion.h"
#include "ssm/voice/span_builder.h"

namespace {

using ssm::SpeechSpan;

ssm::TaggedText Read(std::string_view text) {
  auto read = ssm::ReadMarkup(text);
  EXPECT_TRUE(read) << (read ? "" : read.error().text);
  return read ? std::move(*read) : ssm::TaggedText{};
}
std::string ErrorOf(std::string_view text) {
  auto read = ssm::ReadMarkup(text);
  return read ? "" : read.error().text;
}

TEST(SsmlTest, OnlyASpeakElementIsSsml) {
  EXPECT_TRUE(ssm::IsSsml("<speak>a</speak>"));
  EXPECT_TRUE(ssm::IsSsml(" <?xml version='1.0'?>\n<speak version='1.1'/>"));
  EXPECT_FALSE(ssm::IsSsml("<speaker>"));
  EXPECT_FALSE(ssm::IsSsml("speak"));
  EXPECT_FALSE(ssm::IsSsml("<SPEECH>"));
}

TEST(SsmlTest, MarksAndBreaksStandWhereTheyWereWritten) {
  const auto text = Read("<speak>one <mark name='m'/> <break time='1.5s'/>two<break/></speak>");
  EXPECT_EQ(text.plain, "one two");
  ASSERT_EQ(text.spans.size(), 3u);
  EXPECT_EQ(text.spans[0].text, "one ");
  EXPECT_EQ(text.spans[1].mark, "m");
  EXPECT_EQ(text.spans[1].pause_before.count(), 1500);
  EXPECT_EQ(text.spans[2].pause_before.count(), 300);
}

TEST(SsmlTest, ProsodyTakesWordsFactorsAndDifferences) {
  const auto text = Read(
      "<speak>a<prosody rate='200%' pitch='+2st' volume='-6dB'>b"
      "<prosody rate='slow'>c</prosody></prosody>d<prosody rate='what'>e</prosody></speak>");
  ASSERT_EQ(text.spans.size(), 5u);
  EXPECT_DOUBLE_EQ(text.spans[1].stretch, 0.5);
  EXPECT_NEAR(text.spans[1].pitch, 1.1225, 0.001);
  EXPECT_NEAR(text.spans[1].volume, 0.501, 0.001);
  EXPECT_NEAR(text.spans[2].stretch, 0.5 / 0.75, 1e-9);
  EXPECT_DOUBLE_EQ(text.spans[3].stretch, 1);
  EXPECT_DOUBLE_EQ(text.spans[4].stretch, 1);
}

TEST(SsmlTest, OtherElementsChangeWhatIsSaid) {
  EXPECT_EQ(Read("<speak><sub alias='World Wide Web'>WWW</sub></speak>").plain, "World Wide Web");
  EXPECT_EQ(Read("<speak><say-as interpret-as='characters'>ab1</say-as></speak>").spans[0].text,
            "A, B, 1");
  EXPECT_EQ(Read("<speak><say-as interpret-as='telephone'>03-12</say-as></speak>").spans[0].text,
            "0 3, 1 2");
  EXPECT_EQ(Read("<speak><phoneme ph='キョ’ー'>今日</phoneme></speak>").spans[0].text, "キョ’ー");
  EXPECT_EQ(Read("<speak><phoneme ph='#!'>x</phoneme></speak>").spans[0].text, "x");
  EXPECT_EQ(Read("<speak>a<unknown>b</unknown><metadata>c</metadata></speak>").plain, "ab");
  EXPECT_EQ(Read("<speak><voice name='rms'>b</voice></speak>").spans[0].voice, "rms");
  EXPECT_GT(Read("<speak><emphasis level='strong'>b</emphasis></speak>").spans[0].volume, 1.3);
  EXPECT_EQ(Read("<speak>a<audio src='x.wav'>no</audio></speak>").spans[1].audio, "x.wav");
  EXPECT_EQ(Read("<speak><p><s>a</s><s>b</s></p></speak>").spans[1].pause_before.count(), 200);
}

TEST(SsmlTest, BrokenDocumentsAreNamedWithTheirLine) {
  EXPECT_EQ(ErrorOf("<speak>\n<break></speak>"),
            "SSML line 2: the XML is broken (XML_ERROR_MISMATCHED_ELEMENT)");
  EXPECT_TRUE(ErrorOf("<speak>").starts_with("SSML line 1: the XML is broken"));
  EXPECT_EQ(ErrorOf("<speak><!ENTITY a 'b'></speak>"), "SSML with ENTITY declarations is not read");
  std::string deep = "<speak>";
  for (int i = 0; i < 90; ++i) deep += "<s>";
  for (int i = 0; i < 90; ++i) deep += "</s>";
  EXPECT_EQ(ErrorOf(deep + "</speak>"), "line 1: elements are nested too deep");
}

TEST(TagsTest, SpellingReadingsAndEmphasisOfTheOriginalAreObeyed) {
  EXPECT_EQ(Read("<SPELL>ab</SPELL>").spans[0].text, "A, B");
  EXPECT_EQ(Read("<PRON SYM=\"キョ’ー\">今日</PRON>").spans[0].text, "キョー");
  EXPECT_EQ(Read("<PRON SYM=\"キョ’ー\">今日</PRON>").plain, "今日");
  EXPECT_EQ(Read("<CONTEXT TYPE=\"PHONE\">03-12</CONTEXT>").spans[0].text, "0 3, 1 2");
  EXPECT_EQ(Read("<CONTEXT TYPE=\"NUMBER\">12</CONTEXT>").spans[0].text, "12");
  const auto text = Read("a <EMPH>b</EMPH> <RATE SPEED=\"2\">c<RESET/>d");
  ASSERT_EQ(text.spans.size(), 5u);
  EXPECT_GT(text.spans[1].volume, 1.1);
  EXPECT_DOUBLE_EQ(text.spans[3].stretch, 2);
  EXPECT_DOUBLE_EQ(text.spans[4].stretch, 1);
}

TEST(EmotionTest, StrengthIsBetweenNothingAndTheWhole) {
  EXPECT_DOUBLE_EQ(ssm::MannerOf("SAD", 0)->rate, 1);
  const auto half = ssm::MannerOf("SAD", 50), full = ssm::MannerOf("SAD", 100);
  EXPECT_NEAR(half->rate * half->rate, full->rate, 1e-9);
  EXPECT_LT(full->rate, 1);
  EXPECT_GT(ssm::MannerOf("ANGRY", 100)->volume, 1);
  EXPECT_FALSE(ssm::MannerOf("HUNGRY", 100));
}

}  // namespace
