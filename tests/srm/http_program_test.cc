// The real program with a stand-in for an ear's server, on the virtual clock.

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <fstream>

#include "tests/support/process.h"

namespace {

using support::Process;

/// A second of noise between silences, 16 kHz mono.
std::string SpeechLikeWav() {
  std::string samples;
  std::uint32_t state = 7;
  for (int i = 0; i < 16 * 2600; ++i) {
    state = state * 1664525u + 1013904223u;
    const double level = i > 16 * 800 && i < 16 * 1800 ? 3000 : 20;
    const auto value =
        static_cast<std::int16_t>((static_cast<double>(state >> 16) / 32768 - 1) * level);
    samples += static_cast<char>(value & 0xFF);
    samples += static_cast<char>(value >> 8 & 0xFF);
  }
  const auto number = [](std::size_t value) {
    std::string text;
    for (int i = 0; i < 4; ++i) text += static_cast<char>(value >> (8 * i) & 0xFF);
    return text;
  };
  return "RIFF" + number(36 + samples.size()) + "WAVEfmt " + number(16) +
         std::string("\1\0\1\0", 4) + number(16000) + number(32000) + std::string("\2\0\20\0", 4) +
         "data" + number(samples.size()) + samples;
}

class HttpEarProgramTest : public testing::Test {
 protected:
  HttpEarProgramTest() : server_({"python3", GALATEA_SOURCE_DIR "/tests/support/stub_speech.py"}) {
    port_ = server_.ReadLine().value_or("");
    std::ofstream(folder_ / "key") << "sk-test\n";
    ::chmod((folder_ / "key").c_str(), 0600);
    std::ofstream(folder_ / "said.wav", std::ios::binary) << SpeechLikeWav();
  }
  std::vector<std::string> Hear(const std::string& model, const std::string& more = "") {
    std::ofstream(folder_ / "ear.json")
        << R"({"url": "http://127.0.0.1:)" << port_ << R"(", "key_file": "key", "stall_ms": 400,
               "max_bytes": 100000, "model": ")"
        << model << "\"" << more << "}";
    Process ear({GALATEA_BIN_DIR "/srm", "--clock", "virtual", "--server", folder_ / "ear.json"});
    ear.WriteLine("set Input = wav:" + (folder_ / "said.wav"));
    ear.WriteLine("set Run = START");
    ear.CloseInput();
    auto lines = ear.ReadAll();
    EXPECT_EQ(ear.Wait(), 0) << ear.ErrorText();
    errors_ = ear.ErrorText();
    EXPECT_FALSE((ear.Seen() + errors_).contains("sk-test"));
    return lines;
  }
  static bool Has(const std::vector<std::string>& lines, const std::string& line) {
    return std::ranges::find(lines, line) != lines.end();
  }
  const support::TempDir folder_;
  Process server_;
  std::string port_, errors_;
};

TEST_F(HttpEarProgramTest, AnUtteranceOfARecordingIsHeardByTheServer) {
  EXPECT_TRUE(Has(Hear("say Good morning."), "rep Result = Good morning.")) << errors_;
  const std::string asked = server_.ReadLine().value_or("");
  EXPECT_TRUE(
      asked.starts_with("POST /v1/audio/transcriptions Bearer sk-test say Good morning. "
                        "response_format=json | 16000 Hz 1 2 "))
      << asked;
  EXPECT_TRUE(
      Has(Hear("words one two", R"(, "words": true, "language": "en")"), "rep Result = one two"));
  EXPECT_TRUE(server_.ReadLine().value_or("").contains(
      "language=en response_format=verbose_json timestamp_granularities[]=word |"));
}

TEST_F(HttpEarProgramTest, EveryFaultIsOneErrorAndNoMatch) {
  struct Case {
    const char* model;
    const char* error;
  };
  for (const Case& one :
       {Case{"401", "ACCESS "}, Case{"500", "UNAVAILABLE "}, Case{"429", "BUSY "},
        Case{"307", "UNAVAILABLE "}, Case{"nonsense", "SYNTAX "}, Case{"text", "SYNTAX "},
        Case{"error", "UNAVAILABLE "}, Case{"big", "TOO_LONG "}, Case{"short", "UNAVAILABLE "},
        Case{"close", "UNAVAILABLE "}}) {
    EXPECT_TRUE(Has(Hear(one.model), "rep NoMatch = ")) << one.model;
    EXPECT_TRUE(errors_.contains(std::string(one.error) + "http://127.0.0.1:" + port_))
        << one.model << ": " << errors_;
    EXPECT_EQ(std::count(errors_.begin(), errors_.end(), '\n'), 1) << errors_;
  }
}

TEST_F(HttpEarProgramTest, AConfigurationThatIsWrongIsOneSentence) {
  std::ofstream(folder_ / "bad.json") << R"({"url": "http://x"})";
  Process ear({GALATEA_BIN_DIR "/srm", "--server", folder_ / "bad.json"});
  ear.CloseInput();
  EXPECT_EQ(ear.Wait(), 1);
  EXPECT_TRUE(ear.ErrorText().contains("bad.json: ear: \"model\" must be a text"))
      << ear.ErrorText();
}

}  // namespace
