#include "ssm/voice/text_tags.h"

#include <gtest/gtest.h>

#include "ssm/voice/speakers.h"

namespace ssm {
namespace {

TEST(SpeakerTableTest, AnUnknownSpeakerIsToldWhoThereIsAndThatThereAreMore) {
  const std::vector<VoiceInfo> voices = {{.name = "slt", .language = "en", .female = true},
                                         {.name = "espeak-de", .language = "de", .listed = false}};
  const auto wanted = SpeakerTable(voices, {}).Wanted("siri");
  ASSERT_FALSE(wanted);
  EXPECT_EQ(wanted.error().text,
            "unknown speaker 'siri', expected one of: slt, or one of 1 more such as espeak-de "
            "(inq Speaker.all names them)");
}

TEST(TextTagsTest, PlainTextIsOneSpan) {
  const auto tagged = ParseTaggedText("Hello there.");
  EXPECT_EQ(tagged.plain, "Hello there.");
  ASSERT_EQ(tagged.spans.size(), 1u);
  EXPECT_EQ(tagged.spans[0].text, "Hello there.");
  EXPECT_TRUE(ParseTaggedText("").spans.empty());
}

TEST(TextTagsTest, MannersNestAndEnd) {
  const auto tagged = ParseTaggedText(
      "a<RATE SPEED=\"2\">b<VOLUME LEVEL=\"0.5\">c</VOLUME>d<PITCH LEVEL=\"1.5\"><VOICE "
      "OPTIONAL=\"male01\">e</VOICE></PITCH></RATE>f");
  EXPECT_EQ(tagged.plain, "abcdef");
  ASSERT_EQ(tagged.spans.size(), 6u);
  EXPECT_EQ(tagged.spans[1].stretch, 2);
  EXPECT_EQ(tagged.spans[2].stretch, 2);
  EXPECT_EQ(tagged.spans[2].volume, 0.5);
  EXPECT_EQ(tagged.spans[3].volume, 1);
  EXPECT_EQ(tagged.spans[4].pitch, 1.5);
  EXPECT_EQ(tagged.spans[4].voice, "male01");
  EXPECT_EQ(tagged.spans[5].stretch, 1);
  EXPECT_EQ(tagged.spans[5].voice, "");
}

TEST(TextTagsTest, SilencesAndMarksStandBetween) {
  const auto tagged = ParseTaggedText(
      "<SILENCE MSEC=\"100\"/>a<SILENCE MSEC=\"200\"><BOOKMARK MARK=\"x\"/>b<SILENCE "
      "MSEC=\"50\"/>");
  EXPECT_EQ(tagged.plain, "ab");
  ASSERT_EQ(tagged.spans.size(), 3u);
  EXPECT_EQ(tagged.spans[0].pause_before.count(), 100);
  EXPECT_EQ(tagged.spans[1].pause_before.count(), 200);
  EXPECT_EQ(tagged.spans[1].mark, "x");
  EXPECT_EQ(tagged.spans[2].text, "");
  EXPECT_EQ(tagged.spans[2].pause_before.count(), 50);
}

TEST(TextTagsTest, UnsupportedTagsAreTakenOutAndTheirTextStays) {
  EXPECT_EQ(ParseTaggedText("<SPEECH><EMPH>very</EMPH> <SPELL>abc</SPELL> <PRON SYM=\"x\">y</PRON> "
                            "<CONTEXT TYPE=\"DATE\" FORMAT=\"mdy\">3/4</CONTEXT><APB/></SPEECH>")
                .plain,
            "very abc y 3/4");
}

TEST(TextTagsTest, WhatIsNoTagIsText) {
  for (const char* text :
       {"1 < 2", "<b>bold</b>", "a <", "<", "<RATE", "<RATE SPEED>", "<RATE SPEED=2>",
        "<RATE SPEED=\"2>", "</>", "<>", "<rate speed=\"2\">", "x > y"}) {
    EXPECT_EQ(ParseTaggedText(text).plain, text);
  }
}

TEST(TextTagsTest, LoneClosingTagsAreDropped) {
  const auto tagged = ParseTaggedText("</RATE>a</VOLUME>b");
  EXPECT_EQ(tagged.plain, "ab");
}

TEST(TextTagsTest, NumbersAreTakenToTheirRange) {
  EXPECT_EQ(ParseTaggedText("<RATE SPEED=\"0\">a</RATE>").spans[0].stretch, 0.2);
  EXPECT_EQ(ParseTaggedText("<VOLUME LEVEL=\"-3\">a</VOLUME>").spans[0].volume, 0.01);
  EXPECT_EQ(ParseTaggedText("<PITCH LEVEL=\"99\">a</PITCH>").spans[0].pitch, 2);
  EXPECT_EQ(ParseTaggedText("<SILENCE MSEC=\"1e9\"/>a").spans[0].pause_before.count(), 60000);
  EXPECT_EQ(ParseTaggedText("<RATE SPEED=\"fast\">a</RATE>").spans[0].stretch, 1);
  EXPECT_EQ(ParseTaggedText("<RATE SPEED=\"nan\">a</RATE>").spans[0].stretch, 1);
}

TEST(TextTagsTest, EntitiesStandForTheirSigns) {
  EXPECT_EQ(ParseTaggedText("a &lt; b &amp; c &gt; &quot;d&quot; &x;").plain,
            "a < b & c > \"d\" &x;");
}

}  // namespace
}  // namespace ssm
