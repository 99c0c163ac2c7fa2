// The heads of voice files, made in memory.

#include "ssm/engines/voice_file.h"

#include <gtest/gtest.h>

#include <fstream>

#include "ssm/engines/wav_piece.h"

namespace {

const std::string kHead =
    "[GLOBAL]\nHTS_VOICE_VERSION:1.0\nSAMPLING_FREQUENCY:16000\nFRAME_PERIOD:80\nNUM_STATES:5\n"
    "NUM_STREAMS:2\nSTREAM_TYPE:MCP,LF0\nFULLCONTEXT_FORMAT:HTS_TTS_JPN\nCOMMENT:\n[STREAM]\n"
    "VECTOR_LENGTH[MCP]:25\n[POSITION]\nDURATION_PDF:0-9\nDURATION_TREE:10-19\n"
    "STREAM_WIN[MCP]:20-24,25-29\nSTREAM_PDF[MCP]:30-39\n[DATA]\n";

class VoiceFileTest : public testing::Test {
 protected:
  std::string Write(const std::string& bytes) {
    const std::string path = folder_.File("a.htsvoice");
    std::ofstream(path, std::ios::binary) << bytes;
    return path;
  }
  std::string ErrorOf(const std::string& bytes) {
    auto head = ssm::ReadVoiceFileHead(Write(bytes));
    return head ? "" : head.error().text;
  }
  std::string Told(const std::string& what) const {
    return "voice file '" + folder_.File("a.htsvoice") + "': " + what;
  }
  const ssm::TemporaryFolder folder_;
};

TEST_F(VoiceFileTest, ItsHeadIsRead) {
  auto head = ssm::ReadVoiceFileHead(Write(kHead + std::string(40, 'x')));
  ASSERT_TRUE(head) << head.error().text;
  EXPECT_EQ(head->values.at("SAMPLING_FREQUENCY"), "16000");
  EXPECT_EQ(head->values.at("VECTOR_LENGTH[MCP]"), "25");
  EXPECT_FALSE(head->values.contains("DURATION_PDF"));
}

TEST_F(VoiceFileTest, WhatIsWrongIsNamedWithTheFile) {
  EXPECT_EQ(ErrorOf(kHead + std::string(39, 'x')),
            Told("STREAM_PDF[MCP] is at 30-39, but there are 39 bytes of data"));
  EXPECT_EQ(ErrorOf("RIFF"),
            "'" + folder_.File("a.htsvoice") + "' is no voice file, expected it to begin [GLOBAL]");
  EXPECT_EQ(ErrorOf("[GLOBAL]\nX:1\n"), Told("there is no [DATA] after its head"));
  EXPECT_EQ(ErrorOf("[GLOBAL]\nnonsense\n[DATA]\n"),
            Told("line 2: found 'nonsense', expected KEY:VALUE"));
  EXPECT_EQ(ErrorOf("[GLOBAL]\n[DATA]\n"), Told("there is no HTS_VOICE_VERSION"));
  EXPECT_EQ(ErrorOf("[GLOBAL]\n[POSITION]\nA:3-x\n[DATA]\n0123456"),
            Told("A is at 3-x, but there are 7 bytes of data"));
  EXPECT_TRUE(ErrorOf("[GLOBAL]\n[POSITION]\nA:5-4\n[DATA]\n0123456").starts_with(Told("A is at")));
  auto none = ssm::ReadVoiceFileHead("/nowhere/a");
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().text, "cannot read voice file '/nowhere/a': No such file or directory");
}

TEST_F(VoiceFileTest, VoicesOfOtherKindsAreNotMixed) {
  auto first = ssm::ReadVoiceFileHead(Write(kHead + std::string(40, 'x')));
  ASSERT_TRUE(first);
  EXPECT_TRUE(ssm::CheckVoicesFit(*first, *first, "b"));
  auto other = *first;
  other.values["COMMENT"] = "sad";
  EXPECT_TRUE(ssm::CheckVoicesFit(*first, other, "b"));
  other.values["SAMPLING_FREQUENCY"] = "48000";
  auto fit = ssm::CheckVoicesFit(*first, other, "b");
  ASSERT_FALSE(fit);
  EXPECT_EQ(fit.error().text,
            "voice file 'b': SAMPLING_FREQUENCY is '48000', expected '16000' as of the voice it is "
            "mixed with");
}

}  // namespace
