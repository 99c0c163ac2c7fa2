// A client written for the original voice module, against ours: it waits for rep Run = LIVE, sets a
// speaker, sets a text, waits for READY, speaks and waits for IDLE. The order of reports is that of
// the original (gtalk 1.5.2), byte for byte but for the values.

#include <gtest/gtest.h>

#include <regex>
#include <string>
#include <vector>

#include "tests/support/process.h"

namespace {

using support::Process;
using support::SocketClient;

/// What the original says to a text and to Speak = NOW; VALUE stands for anything.
const std::vector<std::string> kToText = {
    "rep Speak.stat = PROCESSING", "rep Text.text = Hello world.", "rep Speak.text = Hello world.",
    "rep Text.pho = VALUE",        "rep Speak.pho = VALUE",        "rep Text.dur = VALUE",
    "rep Speak.dur = VALUE",       "rep Speak.stat = READY"};
const std::vector<std::string> kToSpeak = {"rep Speak.stat = SPEAKING", "rep Speak.len = VALUE",
                                           "rep Speak.utt = VALUE", "rep Speak.stat = IDLE"};

class OriginalClientTest : public testing::TestWithParam<const char*> {
 protected:
  /// Lines up to `last`, terminators removed, sync events left out.
  static std::vector<std::string> ReadTo(support::LineStream& stream, const std::string& last,
                                         const std::string& terminator) {
    std::vector<std::string> lines;
    while (lines.empty() || lines.back() != last) {
      auto line = stream.ReadLine();
      if (!line) break;
      EXPECT_TRUE(line->ends_with(terminator)) << *line;
      line->resize(line->size() - terminator.size());
      if (!line->starts_with("tell Speak.sync = ")) lines.push_back(*line);
    }
    return lines;
  }

  static void ExpectLines(const std::vector<std::string>& said,
                          const std::vector<std::string>& wanted) {
    ASSERT_EQ(said.size(), wanted.size()) << testing::PrintToString(said);
    for (std::size_t i = 0; i < said.size(); ++i) {
      std::string pattern = std::regex_replace(wanted[i], std::regex("[.\\[\\]]"), "\\$&");
      pattern = std::regex_replace(pattern, std::regex("VALUE"), ".+");
      EXPECT_TRUE(std::regex_match(said[i], std::regex(pattern)))
          << said[i] << " against " << pattern;
    }
  }

  static void Converse(support::LineStream& stream, const std::string& terminator) {
    ASSERT_TRUE(stream.Expect("rep Run = LIVE"));
    stream.Write("inq SpeakerSet" + terminator + "\n");
    const auto speakers = stream.Expect("rep SpeakerSet = ");
    ASSERT_TRUE(speakers);
    std::string speaker = speakers->substr(std::string("rep SpeakerSet = ").size());
    speaker = speaker.substr(0, speaker.find_first_of(" ."));
    stream.Write("set Speaker = " + speaker + terminator + "\n");
    ASSERT_TRUE(stream.Expect("rep Speaker = " + speaker + terminator));
    stream.Write("set Text = Hello world." + terminator + "\n");
    ExpectLines(ReadTo(stream, "rep Speak.stat = READY", terminator), kToText);
    stream.Write("set Speak = NOW" + terminator + "\n");
    ExpectLines(ReadTo(stream, "rep Speak.stat = IDLE", terminator), kToSpeak);
  }

  static std::vector<std::string> Command(std::vector<std::string> more) {
    std::vector<std::string> command{std::string(GALATEA_BIN_DIR "/") + GetParam()};
    if (std::string(GetParam()) == "ssm") more.insert(more.end(), {"--sink", "null"});
    command.insert(command.end(), more.begin(), more.end());
    return command;
  }
};

TEST_P(OriginalClientTest, WorksOverStdio) {
  Process voice(Command({}));
  Converse(voice, "");
}

TEST_P(OriginalClientTest, WorksOverASocketWithDotSlashFraming) {
  const std::string port = std::string(GetParam()) == "ssm" ? "10611" : "10612";
  Process voice(Command({"-p", port}));
  const auto client = SocketClient::Tcp(static_cast<unsigned short>(std::stoi(port)));
  Converse(*client, "./");
}

INSTANTIATE_TEST_SUITE_P(Voices, OriginalClientTest, testing::Values("ssm", "ssm_stub"));

}  // namespace
