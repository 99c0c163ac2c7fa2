// An ear by HTTP: what is sent, what is made of answers; the module with it, on a virtual clock.

#include "srm/http/http_transcriber.h"

#include <gtest/gtest.h>

#include "sound/audio_source.h"
#include "srm/core/recognizer_module.h"
#include "tests/chat/fake_transport.h"

namespace {

using srm::Millis;
using Lines = std::vector<std::string>;

constexpr const char* kUrl = "http://x/v1/audio/transcriptions";

std::string TextOf(const std::string& body) {
  auto heard = srm::ReadTranscript(body);
  return heard ? heard->text : "ERROR " + vm::FormatError(heard.error());
}

TEST(ReadTranscriptTest, WordsTimesAndConfidenceAreRead) {
  auto heard = srm::ReadTranscript(
      R"({"text": " Yes,\n please. ", "words": [{"word": "Yes", "start": 0.31, "end": 0.62}, 7,
          {"word": "please", "start": -4, "end": 1e9}],
          "segments": [{"avg_logprob": 0}, {"avg_logprob": -0.6931}]})");
  ASSERT_TRUE(heard) << heard.error().text;
  EXPECT_EQ(heard->text, "Yes, please.");
  ASSERT_EQ(heard->words.size(), 2u);
  EXPECT_EQ(heard->words[0].start, Millis(310));
  EXPECT_EQ(heard->words[1].start, Millis(0));
  EXPECT_EQ(heard->words[1].end, Millis(7'200'000));
  EXPECT_NEAR(heard->confidence, 0.75, 1e-4);
}

TEST(ReadTranscriptTest, AnythingElseIsAnErrorThatShowsIt) {
  EXPECT_EQ(TextOf(""), "ERROR SYNTAX expected {\"text\": ...}, got ''");
  EXPECT_EQ(TextOf("<html>"), "ERROR SYNTAX expected {\"text\": ...}, got '<html>'");
  EXPECT_EQ(TextOf(R"({"text": 3})"), "ERROR SYNTAX expected {\"text\": ...}, got '{\"text\": 3}'");
  EXPECT_EQ(TextOf(R"({"error": {"message": "too loud"}})"),
            "ERROR UNAVAILABLE the server reports: too loud");
  EXPECT_EQ(TextOf(R"({"text": ""})"), "");
}

TEST(HttpEarSettingsTest, TheConfigurationIsReadAndMistakesAreNamed) {
  auto settings = srm::ParseHttpEar(
      R"({"url": "http://h:1/v1/", "model": "w", "language": "en", "words": true, // ours
          "limit_ms": 5000, "body": {"temperature": 0}})",
      "/dir");
  ASSERT_TRUE(settings) << settings.error().text;
  EXPECT_EQ(settings->server.url, "http://h:1/v1/audio/transcriptions");
  EXPECT_EQ(settings->server.limit, Millis(5000));
  EXPECT_TRUE(settings->words);
  const auto error = [](const char* json) {
    auto parsed = srm::ParseHttpEar(json, "/dir");
    return parsed ? "" : parsed.error().text;
  };
  EXPECT_EQ(error("[]"), "expected a JSON object {\"url\": ..., \"model\": ...}");
  EXPECT_EQ(error(R"({"url": "http://h"})"), "ear: \"model\" must be a text");
  EXPECT_EQ(error(R"({"url": "http://h", "model": "w", "speed": 1})"),
            "ear: unknown key \"speed\"");
  EXPECT_EQ(error(R"({"url": "h", "model": "w"})"),
            "'h' is no address of an ear, expected http://HOST:PORT or https://HOST");
}

/// A source that hands over what the test says, when it says so.
class HandSource final : public sound::AudioSource {
 public:
  explicit HandSource(Events& events) : events_(events) {}
  vm::Result<void> Start(Events events) override {
    events_ = std::move(events);
    return {};
  }
  bool Ends() const override { return false; }

 private:
  Events& events_;
};

class HttpEarTest : public testing::Test {
 protected:
  HttpEarTest() {
    module_ = std::make_unique<srm::RecognizerModule>(
        clock_,
        srm::RecognizerModule::Options{
            .module_version = "test",
            .open_decoder = []() -> vm::Result<std::unique_ptr<srm::SpeechDecoder>> {
              return srm::MakeDeafDecoder();
            },
            .open_spotter = []() -> vm::Result<std::unique_ptr<srm::KeywordSpotter>> {
              return vm::Fail(vm::Errc::kUnavailable, "none");
            },
            .transcriber = std::make_unique<srm::HttpTranscriber>(
                clock_, net_,
                srm::HttpEarSettings{.server = {.url = kUrl, .key = "sk-test"},
                                     .model = "whisper",
                                     .language = "en",
                                     .prompt = "yes, no"}),
            .open_source =
                [this](const std::string&) -> vm::Result<std::unique_ptr<sound::AudioSource>> {
              return std::make_unique<HandSource>(source_);
            }});
    module_->slots().set_output([this](vm::PeerId, const vm::Message& message) {
      said_.push_back(vm::FormatMessage(message));
    });
    module_->slots().set_on_error([this](vm::PeerId, const std::string&, const vm::Error& error) {
      errors_.push_back(vm::FormatError(error));
    });
    Tell("set Input = hand");
    Tell("set Run = START");
    said_.clear();
  }
  void Tell(const std::string& line) { module_->slots().HandleLine(line, 1); }
  void Hear(int ms, double level) {
    std::uint32_t state = 7;
    for (; ms > 0; ms -= 10) {
      std::vector<std::int16_t> samples(160);
      for (std::int16_t& sample : samples) {
        state = state * 1664525u + 1013904223u;
        sample = static_cast<std::int16_t>((static_cast<double>(state >> 16) / 32768 - 1) * level);
      }
      clock_.RunUntil(clock_.Now() + Millis(10));
      source_.sound(samples);
    }
  }
  /// 0.7 s of speech and the silence that ends it.
  void SaySomething() {
    Hear(800, 20);
    Hear(700, 3000);
    Hear(600, 20);
  }
  void Answer(const std::string& body, int status = 200) {
    net_->Head(status, {{"content-type", "application/json"}});
    net_->Data(body);
    net_->End();
    clock_.RunReady();
  }
  Lines Said() { return std::exchange(said_, {}); }

  vm::VirtualScheduler clock_;
  const std::shared_ptr<chat_test::FakeTransport> net_ =
      std::make_shared<chat_test::FakeTransport>();
  sound::AudioSource::Events source_;
  Lines said_, errors_;
  std::unique_ptr<srm::RecognizerModule> module_;
};

TEST_F(HttpEarTest, AnUtteranceIsSentAsAFormWithItsSound) {
  SaySomething();
  ASSERT_EQ(net_->calls.size(), 1u);
  const vm::HttpRequest& request = net_->last().request;
  EXPECT_EQ(request.url, kUrl);
  EXPECT_EQ(request.headers, (Lines{"Authorization: Bearer sk-test",
                                    "Content-Type: multipart/form-data; boundary=galatea-form"}));
  const std::string head =
      "--galatea-form\r\nContent-Disposition: form-data; name=\"model\"\r\n\r\nwhisper\r\n"
      "--galatea-form\r\nContent-Disposition: form-data; name=\"response_format\"\r\n\r\njson\r\n"
      "--galatea-form\r\nContent-Disposition: form-data; name=\"language\"\r\n\r\nen\r\n"
      "--galatea-form\r\nContent-Disposition: form-data; name=\"prompt\"\r\n\r\nyes, no\r\n"
      "--galatea-form\r\nContent-Disposition: form-data; name=\"file\"; "
      "filename=\"utterance.wav\"\r\nContent-Type: audio/wav\r\n\r\nRIFF";
  EXPECT_EQ(request.body.substr(0, head.size()), head);
  EXPECT_TRUE(request.body.ends_with("\r\n--galatea-form--\r\n"));
  // Lead, speech and the silence that ended it.
  EXPECT_NEAR(static_cast<double>(request.body.size() - head.size()) / 32, 300 + 700 + 500, 30);
}

TEST_F(HttpEarTest, TheAnswerIsMatchedToTheActiveGrammarOrStandsAsItIs) {
  SaySomething();
  EXPECT_TRUE(module_->Busy());
  EXPECT_EQ(Said(), (Lines{"rep Listen.stat = SPEECH", "rep Listen.stat = LISTENING"}));
  Answer(R"({"text": "Yes, please!"})");
  EXPECT_FALSE(module_->Busy());
  EXPECT_EQ(Said(),
            (Lines{"rep Result.grammar = ", "rep Result.tag = ", "rep Result = Yes, please!"}));
  Tell("set Grammar.load = answer yes [please] {YES} | no {NO}");
  Tell("set Grammar = answer");
  Said();
  SaySomething();
  Answer(R"({"text": "Yes, please!"})");
  EXPECT_EQ(module_->slots().Value("Result.tag"), "YES");
  SaySomething();
  Answer(R"({"text": "Perhaps."})");
  EXPECT_EQ(Said().back(), "rep NoMatch = Perhaps.");
  EXPECT_TRUE(errors_.empty());
}

TEST_F(HttpEarTest, WhatIsSaidMeanwhileIsAskedAboutInOrderAndNoMoreThanFewWait) {
  for (int i = 0; i < 6; ++i) SaySomething();
  EXPECT_EQ(net_->calls.size(), 1u) << "one after the other";
  EXPECT_EQ(errors_, (Lines{std::string("LIMIT ") + kUrl +
                            ": 4 utterances wait already, this one is not heard"}));
  Said();
  for (int i = 1; i <= 5; ++i) Answer("{\"text\": \"" + std::to_string(i) + "\"}");
  Lines results;
  for (const std::string& line : Said()) {
    if (line.starts_with("rep Result = ")) results.push_back(line.substr(13));
  }
  EXPECT_EQ(results, (Lines{"1", "2", "3", "4", "5"}));
}

TEST_F(HttpEarTest, FaultsAreOneErrorWithoutTheKeyAndTheNextUtteranceIsHeard) {
  SaySomething();
  Answer(R"({"error": {"message": "no such key: sk-test"}})", 401);
  EXPECT_EQ(errors_.back(),
            std::string("ACCESS ") + kUrl + ": the key is refused, 401: no such key: ***");
  EXPECT_EQ(Said().back(), "rep NoMatch = ") << "whoever waits for a result gets one";
  SaySomething();
  net_->End(vm::Fail(vm::Errc::kUnavailable, "no route"));
  clock_.RunReady();
  EXPECT_EQ(errors_.back(), std::string("UNAVAILABLE ") + kUrl + ": no route");
  SaySomething();
  net_->Head(200);
  clock_.RunUntil(clock_.Now() + Millis(20'000));
  EXPECT_EQ(errors_.back(), std::string("TIMEOUT ") + kUrl + ": nothing has come for 20000 ms");
  EXPECT_FALSE(net_->last().open);
  SaySomething();
  Answer(R"({"text": "hello"})");
  EXPECT_EQ(Said().back(), "rep Result = hello");
  EXPECT_EQ(errors_.size(), 3u);
}

TEST_F(HttpEarTest, StopListeningDropsTheRequest) {
  SaySomething();
  Tell("set Run = STOP");
  EXPECT_FALSE(net_->last().open);
  EXPECT_FALSE(module_->Busy());
}

TEST_F(HttpEarTest, PatienceForTheNextWordsBeginsWithTheAnswer) {
  Tell("set Listen.timeout = 1000");
  SaySomething();
  Said();
  clock_.RunUntil(clock_.Now() + Millis(5000));
  EXPECT_EQ(Said(), Lines{});
  Answer(R"({"text": "hello"})");
  Said();
  clock_.RunUntil(clock_.Now() + Millis(1000));
  EXPECT_EQ(Said(), (Lines{"rep NoInput = 1000"}));
}

}  // namespace
