#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "task_manager/app/readable.h"
#include "task_manager/app/subtitles.h"
#include "tests/support/process.h"

namespace vxml {
namespace {

std::string Both(const std::string& line) { return Readable(line, Sides::kBoth); }

TEST(ReadableTest, BothSidesAreToldWithTimeAndFeeling) {
  EXPECT_EQ(Both(R"({"t":3340,"type":"prompt","text":"Where to?","feelings":["HAPPY","SAD"]})"),
            "0:03.3 agent (happy, sad): Where to?");
  EXPECT_EQ(Both(R"({"t":65000,"type":"result","mode":"voice","utterance":"kyoto","match":true})"),
            "1:05.0 user: kyoto");
  EXPECT_EQ(Both(R"({"t":0,"type":"result","mode":"dtmf","utterance":"12","match":true})"),
            "0:00.0 user: keys 12");
  EXPECT_EQ(Both(R"({"t":0,"type":"result","mode":"voice","utterance":"hm","match":false})"),
            "0:00.0 user: hm (not understood)");
  EXPECT_EQ(Both(R"({"t":0,"type":"result","mode":"voice","utterance":"?","match":false})"),
            "0:00.0 user: (not understood)");
  EXPECT_EQ(Both(R"({"t":0,"type":"event","name":"noinput"})"), "0:00.0 user: (silent)");
  EXPECT_EQ(Both(R"({"t":0,"type":"ignored","input":"yes","why":"bargein"})"),
            "0:00.0 user: yes (not heard)");
  EXPECT_EQ(Both(R"({"t":0,"type":"recorded","ms":2500})"), "0:00.0 user: (recorded 2.5 s)");
}

TEST(ReadableTest, WhoTypesSeesTheAgentAlone) {
  EXPECT_EQ(
      Readable(R"({"t":1,"type":"prompt","text":"Hello.","feelings":["HAPPY"]})", Sides::kAgent),
      "(happy) Hello.");
  EXPECT_EQ(Readable(R"({"t":1,"type":"result","mode":"voice","utterance":"yes","match":true})",
                     Sides::kAgent),
            "");
}

TEST(ReadableTest, LinesOfTheProtocolAreNotShown) {
  for (const char* line :
       {R"({"t":1,"type":"command","line":"to @FSM set FaceExp = HAPPY 1 100 0"})",
        R"({"t":1,"type":"mark","name":"m"})", R"({"t":1,"type":"prompt","text":""})",
        R"({"t":1,"type":"filled","item":"f","value":"x"})"}) {
    EXPECT_EQ(Both(line), "") << line;
  }
  EXPECT_EQ(Both(R"({"t":9,"type":"event","name":"error.semantic","message":"d.vxml:3: x"})"),
            "0:00.0 (error.semantic: d.vxml:3: x)");
  EXPECT_EQ(Both(R"({"t":9,"type":"exit","reason":"exit","value":{"a":1}})"),
            R"(0:00.0 (exit {"a":1}))");
}

TEST(ReadableTest, WhatIsNoLineOfATranscriptStaysAsItIs) {
  EXPECT_EQ(Both("nonsense"), "nonsense");
  for (const char* line : {"[]", "3", "null", R"({"type":3})", R"({"type":"prompt","text":3})"}) {
    EXPECT_EQ(Both(line), "") << line;
  }
}

TEST(SubtitlesTest, SayWhoSpeaksWhileTheySpeak) {
  Subtitles subtitles;
  subtitles.Add(R"({"t":500,"type":"prompt","text":"Where to?","ms":900})");
  subtitles.Add(R"({"t":5000,"type":"result","utterance":"to Kyoto & back","match":true})");
  subtitles.Add(R"({"t":5100,"type":"log","text":"not said"})");
  EXPECT_EQ(subtitles.Srt(),
            "1\n00:00:00,500 --> 00:00:01,400\nWhere to?\n\n"
            "2\n00:00:03,800 --> 00:00:05,000\n<i>to Kyoto & back</i>\n\n");
  EXPECT_EQ(subtitles.Vtt(),
            "WEBVTT\n\n00:00:00.500 --> 00:00:01.400\n<v Agent>Where to?\n\n"
            "00:00:03.800 --> 00:00:05.000\n<v User><i>to Kyoto &amp; back</i>\n\n");
}

TEST(SubtitlesTest, OfWhatWasCutOnlyTheHeardTimeCounts) {
  Subtitles subtitles;
  subtitles.Add(R"({"t":0,"type":"prompt","text":"A long question","ms":9000,"heard_ms":700})");
  EXPECT_NE(subtitles.Srt().find("00:00:00,000 --> 00:00:00,700"), std::string::npos);
}

TEST(SubtitlesTest, WhatTheUserSaidIsShownBetweenWhatTheAgentSays) {
  Subtitles subtitles;
  subtitles.Add(R"({"t":0,"type":"prompt","text":"Well?","ms":1000})");
  subtitles.Add(R"({"t":1500,"type":"result","utterance":"yes","match":true})");
  EXPECT_NE(subtitles.Srt().find("00:00:01,000 --> 00:00:02,200\n<i>yes</i>"), std::string::npos)
      << subtitles.Srt();
  subtitles.Add(R"({"t":1700,"type":"prompt","text":"Good.","ms":600})");
  EXPECT_NE(subtitles.Srt().find("00:00:01,000 --> 00:00:01,700\n<i>yes</i>"), std::string::npos)
      << subtitles.Srt();
}

TEST(SubtitlesTest, LongTextsAreShownInPartsOfTwoLines) {
  Subtitles subtitles;
  std::string words;
  for (int i = 0; i < 40; ++i) words += "word ";
  subtitles.Add(R"({"t":0,"type":"prompt","ms":10000,"text":")" + words + "\"}");
  const std::string srt = subtitles.Srt();
  EXPECT_NE(srt.find("3\n"), std::string::npos) << srt;
  EXPECT_NE(srt.find("--> 00:00:10,000"), std::string::npos) << "the last ends with the words";
  std::size_t from = 0;
  for (std::size_t end; (end = srt.find('\n', from)) != std::string::npos; from = end + 1) {
    EXPECT_LE(end - from, 42U) << srt.substr(from, end - from);
  }
}

TEST(SubtitlesTest, JapaneseIsPartedBetweenSignsAndStopsStayBehindThem) {
  Subtitles subtitles;
  std::string words;
  for (int i = 0; i < 10; ++i) words += "あいうえ。";
  subtitles.Add(R"({"t":0,"type":"prompt","ms":5000,"text":")" + words + "\"}");
  const std::string srt = subtitles.Srt();
  EXPECT_EQ(srt.find("\n。"), std::string::npos) << srt;
  EXPECT_NE(srt.find("あいうえ。\n"), std::string::npos) << srt;
}

TEST(SubtitlesTest, AreWrittenBesideTheFilmAndAFailureNamesTheFile) {
  support::TempDir folder;
  Subtitles subtitles;
  subtitles.Add(R"({"t":0,"type":"prompt","text":"Hello.","ms":900})");
  ASSERT_TRUE(subtitles.WriteBeside(folder / "film.mp4"));
  for (const auto& [ending, text] :
       {std::pair("film.srt", subtitles.Srt()), std::pair("film.vtt", subtitles.Vtt())}) {
    std::ifstream file(folder / ending);
    EXPECT_EQ(std::string(std::istreambuf_iterator<char>(file), {}), text);
  }
  const auto failed = subtitles.WriteBeside(folder / "nowhere/film.mp4");
  ASSERT_FALSE(failed);
  EXPECT_NE(failed.error().text.find("nowhere/film.srt"), std::string::npos);
}

}  // namespace
}  // namespace vxml
