// What goes to files and comes from them.

#include <algorithm>
#include <fstream>

#include "ssm/voice/wav_file.h"
#include "tests/ssm/voice_suite.h"
#include "tests/support/process.h"

namespace ssm_test {
namespace {

class VoiceFilesTest : public VoiceSuite {};
INSTANTIATE_TEST_SUITE_P(Engines, VoiceFilesTest, AllEngines(), EngineName);

TEST_P(VoiceFilesTest, SavedSoundComesBackWithItsPhonemes) {
  const support::TempDir dir;
  const long dur = Prepare();
  const std::string pho = world_.Ask("Text.pho");
  world_.Tell("set SaveWAV = " + dir / "a.wav");
  world_.Tell("set SaveRAW = " + dir / "a.raw");
  EXPECT_EQ(world_.Lines(), Lines{});
  EXPECT_EQ(world_.errors, Lines{});
  const auto wav = ssm::ReadWav(dir / "a.wav");
  const auto raw = ssm::ReadRaw(dir / "a.raw");
  ASSERT_TRUE(wav && raw);
  EXPECT_EQ(wav->size(), ssm::ToFrames(ssm::Millis(dur)));
  EXPECT_EQ(*wav, *raw);

  Prepare("Something else.");
  for (const char* load : {"LoadWAV", "LoadRAW", "SpeechFile"}) {
    const std::string path = dir / (std::string(load) == "LoadWAV" ? "a.wav" : "a.raw");
    world_.Tell(std::string("set ") + load + " = " + path);
    const std::string ms = std::to_string(dur);
    EXPECT_EQ(world_.Lines(),
              (Lines{"rep Speak.stat = PROCESSING", "rep SpeechFile = " + path,
                     "rep Text.pho = " + pho, "rep Speak.pho = " + pho, "rep Text.dur = " + ms,
                     "rep Speak.dur = " + ms, "rep Speak.stat = READY"}));
    world_.Tell("set Speak = NOW");
    world_.UntilIdle();
    EXPECT_EQ(world_.Ask("Speak.len"), ms);
    world_.Lines();
  }
  std::ofstream(dir / "b.wav.info") << "nothing of use\n";
  world_.Tell("set SaveWAV = " + dir / "c.wav");
  std::remove((dir / "c.wav.info").c_str());
  world_.Tell("set#9 LoadWAV = " + dir / "c.wav");
  EXPECT_TRUE(world_.Lines().at(0).starts_with("rep#9 LoadWAV.error = UNAVAILABLE "));
}

TEST_P(VoiceFilesTest, RawSoundIsBigEndian) {
  const support::TempDir dir;
  const std::vector<std::int16_t> samples = {0x0102, -2};
  ASSERT_TRUE(ssm::WriteRaw(dir / "x.raw", samples));
  std::ifstream file(dir / "x.raw", std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(file), {}};
  EXPECT_EQ(bytes, std::string("\x01\x02\xff\xfe", 4));
}

TEST_P(VoiceFilesTest, TheTapeHoldsSpeechExactlyWhereItWasPlayed) {
  const support::TempDir dir;
  Prepare("Hello.");
  world_.Tell("set SaveWAV = " + dir / "speech.wav");
  const auto speech = *ssm::ReadWav(dir / "speech.wav");
  world_.Pass(123);
  world_.Tell("set Record = " + dir / "tape.wav");
  world_.Pass(250);
  world_.Tell("set Speak = +50");
  world_.UntilIdle();
  world_.Pass(100);
  world_.Tell("set Speak = NOW");
  world_.Pass(200);
  world_.Tell("set Speak = STOP");
  world_.Pass(300);
  world_.Tell("set Record = STOP");
  EXPECT_EQ(world_.Ask("Record"), "STOP");
  const auto tape = *ssm::ReadWav(dir / "tape.wav");

  std::vector<std::int16_t> expected(300 * ssm::kFramesPerMs);
  expected.insert(expected.end(), speech.begin(), speech.end());
  expected.resize(expected.size() + 100 * ssm::kFramesPerMs);
  expected.insert(expected.end(), speech.begin(), speech.begin() + 200 * ssm::kFramesPerMs);
  expected.resize(expected.size() + 300 * ssm::kFramesPerMs);
  EXPECT_EQ(tape.size(), expected.size());
  EXPECT_TRUE(tape == expected);
}

TEST_P(VoiceFilesTest, ATapeMayBeginAndEndInTheMiddleOfSpeech) {
  const support::TempDir dir;
  Prepare();
  world_.Tell("set SaveWAV = " + dir / "speech.wav");
  const auto speech = *ssm::ReadWav(dir / "speech.wav");
  world_.Tell("set Speak = NOW");
  world_.Pass(300);
  world_.Tell("set Record = " + dir / "1.wav");
  world_.Pass(400);
  world_.Tell("set Record = " + dir / "2.wav");
  world_.Pass(100);
  world_.module->Shutdown();  // the end of the program closes the tape
  const auto part = [&](int from_ms, int to_ms) {
    return std::vector<std::int16_t>(speech.begin() + from_ms * 16, speech.begin() + to_ms * 16);
  };
  EXPECT_TRUE(*ssm::ReadWav(dir / "1.wav") == part(300, 700));
  EXPECT_TRUE(*ssm::ReadWav(dir / "2.wav") == part(700, 800));
}

TEST_P(VoiceFilesTest, TheLogHasWhatWasChosen) {
  const support::TempDir dir;
  world_.Tell("set Log = " + dir / "log");
  world_.Tell("set Log.text = YES");
  world_.Tell("set Log.phoneme = YES");
  Prepare("Hello.");
  EXPECT_EQ(world_.Ask("Log.text"), "YES");
  world_.Tell("set Log = NO");
  Prepare("Again.");
  std::ifstream file(dir / "log");
  std::string text, phonemes, more;
  std::getline(file, text);
  std::getline(file, phonemes);
  EXPECT_EQ(text, "text: Hello.");
  EXPECT_TRUE(phonemes.starts_with("phoneme: pau["));
  EXPECT_FALSE(std::getline(file, more));
}

}  // namespace
}  // namespace ssm_test
