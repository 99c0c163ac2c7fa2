// A voice behind HTTP, with a stand-in for its server (tests/support/stub_speech.py).

#include "ssm/engines/http_engine.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <fstream>

#include "ssm/flite/flite_engine.h"
#include "ssm/voice/wav_file.h"
#include "tests/ssm/spoken.h"
#include "tests/support/process.h"

namespace {

using ssm_test::kNever;
using ssm_test::Speak;
using std::chrono::milliseconds;
using support::Process;

constexpr const char* kAligner = GALATEA_BIN_DIR "/align";
constexpr const char* kText = "Nobody bought my apples.";

/// The server speaks with the voice of flite, whose phonemes are therefore known.
class HttpEngineTest : public testing::Test {
 protected:
  HttpEngineTest() : truth_(Speak(*ssm::MakeFliteEngine(), {{.text = kText}})) {
    EXPECT_TRUE(ssm::WriteWav(folder_ / "sound.wav", truth_.samples));
    server_ = std::make_unique<Process>(
        std::vector<std::string>{"python3", GALATEA_SOURCE_DIR "/tests/support/stub_speech.py",
                                 "--sound", folder_ / "sound.wav"});
    port_ = server_->ReadLine().value_or("");
  }
  ssm::HttpVoiceOptions Options(const std::string& model, const std::string& format = "wav") {
    return {.name = "nova",
            .server = {.url = "http://127.0.0.1:" + port_ + "/v1/audio/speech", .key = "sk-test"},
            .model = model,
            .voice = "alloy",
            .format = format,
            .rate_hz = 16'000,
            .aligner = access(kAligner, X_OK) == 0 ? kAligner : ""};
  }
  vm::Error ErrorOf(ssm::HttpVoiceOptions options) {
    auto plan = ssm::MakeHttpEngine(std::move(options))->Plan({{.text = kText}}, kNever);
    EXPECT_FALSE(plan);
    return plan ? vm::Error{} : plan.error();
  }

  const ssm_test::Spoken truth_;
  support::TempDir folder_;
  std::unique_ptr<Process> server_;
  std::string port_;
};

TEST_F(HttpEngineTest, EachFormatIsHeardAsItWasSent) {
  for (const char* format : {"wav", "pcm"}) {
    auto engine = ssm::MakeHttpEngine(Options("good", format));
    EXPECT_EQ(Speak(*engine, {{.text = kText}}).samples, truth_.samples) << format;
    EXPECT_EQ(server_->ReadLine(), "POST /v1/audio/speech Bearer sk-test good alloy " +
                                       std::string(format) + " - - | " + kText);
  }
  for (const char* model : {"streamed", "wav"}) {
    auto engine = ssm::MakeHttpEngine(Options(model, model == std::string("wav") ? "pcm" : "wav"));
    EXPECT_EQ(Speak(*engine, {{.text = kText}}).samples, truth_.samples) << model;
  }
  const auto mp3 = Speak(*ssm::MakeHttpEngine(Options("good", "mp3")), {{.text = kText}});
  EXPECT_NEAR(static_cast<double>(mp3.samples.size()), static_cast<double>(truth_.samples.size()),
              16.0 * 150)
      << "the coder puts some silence around it";
  EXPECT_NEAR(ssm_test::Rms(mp3.samples) / ssm_test::Rms(truth_.samples), 1, 0.1);
}

TEST_F(HttpEngineTest, PhonemesAreFoundInTheSoundByItsText) {
  if (access(kAligner, X_OK) != 0) GTEST_SKIP() << "needs align (Debian: libpocketsphinx-dev)";
  const auto plan = Speak(*ssm::MakeHttpEngine(Options("good")), {{.text = kText}}).plan;
  EXPECT_TRUE(plan.unspoken.empty()) << plan.unspoken;
  ASSERT_EQ(plan.words.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_NEAR(static_cast<double>(plan.words[i].start.count()),
                static_cast<double>(truth_.plan.words[i].start.count()), 60)
        << plan.words[i].text;
  }
  // Each closure of the lips lies where the voice that was sent has one.
  const auto closures = [](const vm::PhonemeList& list) {
    std::vector<double> begins;
    double at = 0;
    for (const vm::Phoneme& phoneme : list) {
      if (phoneme.name == "p" || phoneme.name == "b" || phoneme.name == "m") begins.push_back(at);
      at += static_cast<double>(phoneme.duration.count());
    }
    return begins;
  };
  const auto found = closures(plan.phonemes), known = closures(truth_.plan.phonemes);
  ASSERT_EQ(known.size(), 4u);
  ASSERT_EQ(found.size(), known.size()) << vm::FormatPhonemesVoice(plan.phonemes);
  for (std::size_t i = 0; i < known.size(); ++i) EXPECT_NEAR(found[i], known[i], 40);
}

TEST_F(HttpEngineTest, WithoutAlignTheSoundIsHeardAndTheFaceStaysStill) {
  auto options = Options("good");
  options.aligner.clear();
  const auto spoken = Speak(*ssm::MakeHttpEngine(options), {{.text = kText}});
  EXPECT_EQ(spoken.samples, truth_.samples);
  EXPECT_EQ(spoken.plan.phonemes.size(), 1u);
  EXPECT_EQ(spoken.plan.unspoken,
            "the face does not move to voice 'nova': there is no program align");
}

TEST_F(HttpEngineTest, SpeedGoesOverTheWireWithinItsLimits) {
  auto options = Options("good");
  options.server.more = R"({"extra": 7})";
  auto engine = ssm::MakeHttpEngine(options);
  for (const auto& [stretch, speed] :
       {std::pair{0.8, "1.25"}, std::pair{10.0, "0.25"}, std::pair{0.1, "4.0"}}) {
    ASSERT_TRUE(engine->Plan({{.text = kText, .stretch = stretch}}, kNever));
    EXPECT_EQ(server_->ReadLine(),
              std::string("POST /v1/audio/speech Bearer sk-test good alloy wav ") + speed +
                  " 7 | " + kText);
  }
}

TEST_F(HttpEngineTest, EveryFaultIsOneSentenceWithTheAddressAndWithoutTheKey) {
  struct Case {
    const char* model;
    vm::Errc code;
    const char* said;
  };
  for (const Case& one :
       {Case{"401", vm::Errc::kAccess, "the key is refused, 401: stub says no, Bearer ***"},
        Case{"429", vm::Errc::kBusy, "too many requests, 429: "},
        Case{"500", vm::Errc::kUnavailable, "500: stub says no"},
        Case{"307", vm::Errc::kUnavailable, "moved to '/elsewhere'; redirections are not followed"},
        Case{"text", vm::Errc::kBadValue, "expected sound, got '<h1>Welcome</h1>'"},
        Case{"error", vm::Errc::kBadValue, "expected sound, got 'the voice is ill'"},
        Case{"empty", vm::Errc::kBadValue, "has no sound in it"},
        Case{"garbage", vm::Errc::kUnavailable, "no sound: "},
        Case{"short", vm::Errc::kUnavailable, "/v1/audio/speech: "},
        Case{"close", vm::Errc::kUnavailable, "/v1/audio/speech: "},
        Case{"big", vm::Errc::kTooLong, "the answer has more than 200000 bytes"},
        Case{"stall", vm::Errc::kTimeout, "nothing has come for 300 ms"},
        Case{"late", vm::Errc::kTimeout, "nothing has come for 300 ms"}}) {
    auto options = Options(one.model);
    options.server.max_bytes = 200'000;
    options.server.stall = milliseconds(300);
    const vm::Error error = ErrorOf(options);
    EXPECT_EQ(error.code, one.code) << one.model << ": " << error.text;
    EXPECT_TRUE(error.text.starts_with("voice 'nova': http://127.0.0.1:" + port_)) << error.text;
    EXPECT_TRUE(error.text.contains(one.said)) << error.text;
    EXPECT_FALSE(error.text.contains("sk-test")) << error.text;
  }
  auto options = Options("late");
  options.server.limit = milliseconds(200);
  EXPECT_EQ(ErrorOf(options).code, vm::Errc::kTimeout) << "the limit counts as well as the stall";
  server_->Terminate();
  server_->Wait();
  EXPECT_EQ(ErrorOf(Options("good")).code, vm::Errc::kUnavailable);
}

TEST_F(HttpEngineTest, ACancelledTextIsNotWaitedFor) {
  const std::atomic<bool> cancelled{true};
  auto options = Options("late");
  auto plan = ssm::MakeHttpEngine(options)->Plan({{.text = kText}}, cancelled);
  ASSERT_FALSE(plan);
  EXPECT_EQ(plan.error().code, vm::Errc::kStopped);
}

TEST_F(HttpEngineTest, TheVoiceModuleSpeaksWithAConfiguredServer) {
  const std::string key = folder_ / "key";
  std::ofstream(key) << "sk-test\n";
  chmod(key.c_str(), 0600);
  std::ofstream(folder_ / "voices.json")
      << R"({"voices": [{"name": "nova", "engine": "http", "url": "http://127.0.0.1:)" << port_
      << R"(", "model": "good", "voice": "alloy", "key_file": "key"}]})";
  Process voice({GALATEA_BIN_DIR "/ssm", "--sink", "file:" + (folder_ / "out.wav"), "--voices",
                 folder_ / "voices.json", "--speaker", "nova"});
  voice.WriteLine("set Text = " + std::string(kText));
  voice.WriteLine("inq Text.pho");
  voice.WriteLine("set Speak = NOW");
  voice.CloseInput();
  const auto lines = voice.ReadAll();
  EXPECT_EQ(voice.Wait(), 0) << voice.ErrorText();
  EXPECT_NE(std::ranges::find(lines, "rep Speak.len = 2128"), lines.end())
      << voice.Seen() << voice.ErrorText();
  auto heard = ssm::ReadWav(folder_ / "out.wav");
  ASSERT_TRUE(heard);
  EXPECT_NEAR(ssm_test::Rms(*heard), ssm_test::Rms(truth_.samples), 50);
  EXPECT_FALSE((voice.Seen() + voice.ErrorText()).contains("sk-test"));
}

}  // namespace
