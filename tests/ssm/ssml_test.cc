#include "ssm/voice/ssml.h"

#include <gtest/gtest.h>

#include "ssm/voice/emotion.h"
#include "ssm/voice/span_builder.h"
#include "ssm/voice/spoken_forms.h"

namespace {

using ssm::SpeechSpan;

ssm::TaggedText ReadSsml(std::string_view text) {
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
  EXPECT_TRUE(ssm::IsSsml("<!-- c --><speak/>"));
  EXPECT_TRUE(
      ssm::IsSsml("<?xml version='1.0'?><!DOCTYPE speak PUBLIC 'a' 'b'>\n<speak>a</speak>"));
  EXPECT_TRUE(ssm::IsSsml("<!DOCTYPE speak [<!ENTITY a '>'>]><speak/>"));
  EXPECT_TRUE(ssm::IsSsml("<s:speak xmlns:s='http://www.w3.org/2001/10/synthesis'/>"));
  EXPECT_FALSE(ssm::IsSsml("<!-- <speak> -->"));
  EXPECT_FALSE(ssm::IsSsml("<!DOCTYPE speak"));
  EXPECT_FALSE(ssm::IsSsml("<speaker>"));
  EXPECT_FALSE(ssm::IsSsml("speak"));
  EXPECT_FALSE(ssm::IsSsml("<SPEECH>"));
}

TEST(SsmlTest, MarksAndBreaksStandWhereTheyWereWritten) {
  const auto text = ReadSsml("<speak>one <mark name='m'/> <break time='1.5s'/>two<break/></speak>");
  EXPECT_EQ(text.plain, "one two");
  ASSERT_EQ(text.spans.size(), 4u);
  EXPECT_EQ(text.spans[0].text, "one ");
  EXPECT_EQ(text.spans[1].mark, "m");  // before the pause
  EXPECT_EQ(text.spans[1].pause_before.count(), 0);
  EXPECT_EQ(text.spans[2].pause_before.count(), 1500);
  EXPECT_EQ(text.spans[2].text, "two");
  EXPECT_EQ(text.spans[3].pause_before.count(), 300);
}

TEST(SsmlTest, ProsodyTakesWordsFactorsAndDifferences) {
  const auto text = ReadSsml(
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
  EXPECT_EQ(ReadSsml("<speak><sub alias='World Wide Web'>WWW</sub></speak>").plain,
            "World Wide Web");
  EXPECT_EQ(ReadSsml("<speak><say-as interpret-as='characters'>ab1</say-as></speak>").spans[0].text,
            "A, B, 1");
  EXPECT_EQ(
      ReadSsml("<speak><say-as interpret-as='telephone'>03-12</say-as></speak>").spans[0].text,
      "0 3, 1 2");
  EXPECT_EQ(ReadSsml("<speak><phoneme ph='キョ’ー'>今日</phoneme></speak>").spans[0].text,
            "キョ’ー");
  EXPECT_EQ(ReadSsml("<speak><phoneme ph='#!'>x</phoneme></speak>").spans[0].text, "x");
  EXPECT_EQ(ReadSsml("<speak>a<unknown>b</unknown><metadata>c</metadata></speak>").plain, "a b");
  EXPECT_EQ(ReadSsml("<speak><voice name='rms'>b</voice></speak>").spans[0].voice, "rms");
  EXPECT_GT(ReadSsml("<speak><emphasis level='strong'>b</emphasis></speak>").spans[0].volume, 1.3);
  EXPECT_EQ(ReadSsml("<speak>a<audio src='x.wav'>no</audio></speak>").spans[1].audio, "x.wav");
  EXPECT_EQ(ReadSsml("<speak><p><s>a</s><s>b</s></p></speak>").spans[1].pause_before.count(), 200);
}

TEST(SsmlTest, BrokenDocumentsAreNamedWithTheirLine) {
  EXPECT_EQ(ErrorOf("<speak>\n<break></speak>"), "SSML:2:10: mismatched tag");
  EXPECT_TRUE(ErrorOf("<speak>").starts_with("SSML:1:8: "));
  EXPECT_TRUE(ErrorOf("<speak/><speak/>").starts_with("SSML:1:9: "));
  EXPECT_TRUE(ErrorOf("<speak>a&nbsp;b</speak>").starts_with("SSML:1:"));
  std::string deep = "<speak>";
  for (int i = 0; i < 90; ++i) deep += "<s>";
  for (int i = 0; i < 90; ++i) deep += "</s>";
  EXPECT_TRUE(ErrorOf(deep + "</speak>").ends_with("elements nested deeper than 64"));
}

TEST(SsmlTest, EntitiesAreXmlsAndBombsAreRefused) {
  EXPECT_EQ(ReadSsml("<!DOCTYPE speak [<!ENTITY who 'Anna'>]><speak>I am &who;.</speak>").plain,
            "I am Anna.");
  std::string bomb = "<!DOCTYPE speak [<!ENTITY a0 '0123456789'>";
  for (int i = 1; i < 9; ++i) {
    const std::string before = "&a" + std::to_string(i - 1) + ";";
    bomb += "<!ENTITY a" + std::to_string(i) + " '";
    for (int k = 0; k < 10; ++k) bomb += before;
    bomb += "'>";
  }
  EXPECT_FALSE(ErrorOf(bomb + "]><speak>&a8;</speak>").empty());
}

TEST(SsmlTest, ProsodyTakesEveryFormOfTheStandard) {
  const auto one = [](const std::string& attributes) {
    return ReadSsml("<speak><prosody " + attributes + ">a</prosody></speak>").spans[0];
  };
  EXPECT_DOUBLE_EQ(one("volume='50'").volume, 0.5);
  EXPECT_DOUBLE_EQ(one("volume='0'").volume, 0);
  EXPECT_DOUBLE_EQ(one("volume='+10'").volume, 1.1);
  EXPECT_DOUBLE_EQ(one("volume='silent'").volume, 0);
  EXPECT_DOUBLE_EQ(one("pitch='250Hz'").intonation.hz, 250);
  EXPECT_DOUBLE_EQ(one("pitch='-30Hz'").intonation.shift_hz, -30);
  EXPECT_NEAR(one("pitch='-2st'").pitch, 0.8909, 0.001);
  EXPECT_GT(one("range='high'").intonation.range, 1.2);
  EXPECT_DOUBLE_EQ(one("range='-50%'").intonation.range, 0.5);
  EXPECT_EQ(one("duration='2.5s'").lasts.count(), 2500);
  const auto contour = one("contour='(0%,+20Hz) (50%,200Hz)(100%,-10%)'").intonation.contour;
  ASSERT_EQ(contour.size(), 3u);
  EXPECT_DOUBLE_EQ(contour[0].shift_hz, 20);
  EXPECT_DOUBLE_EQ(contour[1].hz, 200);
  EXPECT_DOUBLE_EQ(contour[1].at01, 0.5);
  EXPECT_DOUBLE_EQ(contour[2].factor, 0.9);
}

TEST(SsmlTest, WhatCannotBeDoneIsSaid) {
  EXPECT_TRUE(
      ReadSsml("<speak>a<prosody rate='slow' pitch='+1st'>b</prosody></speak>").notes.empty());
  const auto notes =
      ReadSsml(
          "<speak><prosody rate='quick' contour='up'>a</prosody><voice age='9'>b</voice>"
          "<say-as interpret-as='riddle'>c</say-as><prosody rate='quick'>d</prosody></speak>")
          .notes;
  ASSERT_EQ(notes.size(), 4u);
  EXPECT_EQ(notes[0], "SSML: <prosody rate=\"quick\"> is not understood");
  EXPECT_EQ(notes[1], "SSML: <prosody contour=\"up\"> is not understood");
  EXPECT_EQ(notes[2], "SSML: no voice here has an age; <voice age> is not obeyed");
  EXPECT_EQ(notes[3], "SSML: <say-as interpret-as=\"riddle\"> is not understood");
}

TEST(SsmlTest, AudioFallsBackOnItsContent) {
  const ssm::MarkupOptions options{
      .is_sound = [](const std::string& path) { return path == "good.wav"; }};
  const auto read = ssm::ReadMarkup(
      "<speak>a <audio src='bad.wav'>instead <desc>a bell</desc></audio>"
      "<audio src='good.wav' soundLevel='-6dB' speed='200%' clipBegin='1s' clipEnd='2s' "
      "repeatCount='3' repeatDur='4s'>not this</audio> b</speak>",
      options);
  ASSERT_TRUE(read);
  EXPECT_EQ(read->plain, "a instead b");
  ASSERT_EQ(read->spans.size(), 4u);
  const SpeechSpan& played = read->spans[2];
  EXPECT_EQ(played.audio, "good.wav");
  EXPECT_NEAR(played.volume, 0.501, 0.001);
  EXPECT_DOUBLE_EQ(played.clip.speed, 2);
  EXPECT_EQ(played.clip.begin.count(), 1000);
  EXPECT_EQ(played.clip.end.count(), 2000);
  EXPECT_DOUBLE_EQ(played.clip.repeats, 3);
  EXPECT_EQ(played.clip.most.count(), 4000);
  EXPECT_TRUE(read->spans[3].audio.empty());
  EXPECT_DOUBLE_EQ(read->spans[3].clip.speed, 1);
}

TEST(SsmlTest, LanguagesAndVoicesAreAskedFor) {
  const auto text = ReadSsml(
      "<speak version='1.1' xml:lang='en'>a<lang xml:lang='ja'>2026</lang>"
      "<voice gender='male' languages='de'>b</voice>c</speak>");
  ASSERT_EQ(text.spans.size(), 4u);
  EXPECT_EQ(text.spans[0].language, "");
  EXPECT_EQ(text.spans[1].language, "ja");
  EXPECT_EQ(text.spans[2].gender, "male");
  EXPECT_EQ(text.spans[2].language, "de");
  EXPECT_EQ(text.spans[3].language, "");
}

TEST(SsmlTest, LexiconsGiveWordsTheirPronunciation) {
  const ssm::MarkupOptions options{.read_file = [](const std::string&) {
    return vm::Result<std::string>(
        "<lexicon version='1.0' alphabet='ipa' xmlns='http://www.w3.org/2005/01/"
        "pronunciation-lexicon'><lexeme><grapheme>W3C</grapheme><alias>World Wide Web Consortium"
        "</alias></lexeme><lexeme><grapheme>Nice</grapheme><phoneme>niːs</phoneme></lexeme>"
        "</lexicon>");
  }};
  const auto spans = [&](const std::string& text) {
    const auto read = ssm::ReadMarkup(text, options);
    EXPECT_TRUE(read) << text;
    EXPECT_TRUE(read->notes.empty()) << text;
    return read->spans;
  };
  EXPECT_EQ(spans("<speak version='1.0'><lexicon uri='l'/>The W3C.</speak>")[0].text,
            "The World Wide Web Consortium.");
  const std::string head = "<speak version='1.1'><lexicon uri='l' xml:id='x'/>";
  EXPECT_EQ(spans(head + "The W3C.</speak>")[0].text, "The W3C.");
  EXPECT_EQ(spans(head + "<lookup ref='x'>in Nice, Nicer W3C</lookup></speak>")[0].text,
            "in \uE000niːs\uE001Nice\uE002, Nicer World Wide Web Consortium");
}

TEST(SsmlTest, SentencesHaveABlankBetweenThemInTheText) {
  EXPECT_EQ(ReadSsml("<speak><p>One.</p><p>Two.</p></speak>").plain, "One. Two.");
}

struct Form {
  const char *how, *format, *text, *english, *japanese;
};

TEST(SpokenFormTest, IsTheOneOfItsMeaningAndLanguage) {
  const Form forms[] = {
      {"characters", "", "ab1", "A, B, 1", "A, B, 1"},
      {"digits", "", "203", "2 0 3", "2 0 3"},
      {"telephone", "", "+81 3-12", "plus 8 1, 3, 1 2", "プラス、8 1, 3, 1 2"},
      {"cardinal", "", "1,203", "one thousand two hundred and three", "1,203"},
      {"cardinal", "", "-7", "minus seven", "マイナス7"},
      {"number", "ordinal", "21", "twenty first", "21番目"},
      {"ordinal", "", "112th", "one hundred and twelfth", "112番目"},
      {"ordinal", "", "40", "fortieth", "40番目"},
      {"date", "mdy", "11/24/2026", "November twenty fourth, twenty twenty six", "2026年11月24日"},
      {"date", "", "2005-01-03", "January third, two thousand and five", "2005年1月3日"},
      {"date", "dm", "3.1", "January third", "1月3日"},
      {"date", "y", "1905", "nineteen oh five", "1905年"},
      {"time", "", "2:05pm", "two oh five P M", "午後2時5分"},
      {"time", "hms12", "14:30", "two thirty P M", "午後2時30分"},
      {"time", "", "14:30:01", "fourteen thirty and one second", "14時30分1秒"},
      {"time", "", "9:00", "nine o'clock", "9時0分"},
      {"currency", "", "$20.50", "twenty dollars and fifty cents", "20.50ドル"},
      {"currency", "", "EUR 1", "one euro", "1ユーロ"},
      {"currency", "", "¥500", "five hundred yen", "500円"},
  };
  for (const Form& form : forms) {
    EXPECT_EQ(ssm::SpokenForm(form.how, form.format, form.text, "en-US").value_or("none"),
              form.english)
        << form.how << " " << form.text;
    EXPECT_EQ(ssm::SpokenForm(form.how, form.format, form.text, "ja").value_or("none"),
              form.japanese)
        << form.how << " " << form.text;
  }
  for (const Form& none : {Form{"date", "", "13/32", "", ""}, Form{"time", "", "late", "", ""},
                           Form{"currency", "", "5", "", ""}, Form{"ordinal", "", "x", "", ""},
                           Form{"colour", "", "red", "", ""}}) {
    EXPECT_FALSE(ssm::SpokenForm(none.how, none.format, none.text, "en")) << none.text;
  }
}

TEST(TagsTest, SpellingReadingsAndEmphasisOfTheOriginalAreObeyed) {
  EXPECT_EQ(ReadSsml("<SPELL>ab</SPELL>").spans[0].text, "A, B");
  EXPECT_EQ(ReadSsml("<PRON SYM=\"キョ’ー\">今日</PRON>").spans[0].text, "キョー");
  EXPECT_EQ(ReadSsml("<PRON SYM=\"キョ’ー\">今日</PRON>").plain, "今日");
  EXPECT_EQ(ReadSsml("<CONTEXT TYPE=\"PHONE\">03-12</CONTEXT>").spans[0].text, "0 3, 1 2");
  EXPECT_EQ(ReadSsml("<CONTEXT TYPE=\"NUMBER\">12</CONTEXT>").spans[0].text, "12");
  const auto text = ReadSsml("a <EMPH>b</EMPH> <RATE SPEED=\"2\">c<RESET/>d");
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
