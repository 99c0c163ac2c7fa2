// The module with a decoder that hears what it is told, on a virtual clock; and the end-pointer.

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <numbers>

#include "sound/sound_file.h"
#include "srm/core/recognizer_module.h"
#include "tests/support/process.h"
#include "vm_protocol/core/scheduler.h"

namespace {

using srm::Millis;

std::vector<std::int16_t> Sound(int ms, double level) {
  std::vector<std::int16_t> samples(static_cast<std::size_t>(ms) * srm::kFramesPerMs);
  std::uint32_t state = 7;
  for (std::int16_t& sample : samples) {
    state = state * 1664525u + 1013904223u;
    sample = static_cast<std::int16_t>((static_cast<double>(state >> 16) / 32768 - 1) * level);
  }
  return samples;
}
void Add(std::vector<std::int16_t>& to, const std::vector<std::int16_t>& more) {
  to.insert(to.end(), more.begin(), more.end());
}

struct Log {
  std::string events;
  srm::Endpointer::Events Events() {
    return {.begin = [this] { events += "begin "; },
            .sound = [this](std::span<const std::int16_t> s) { length += s.size(); },
            .end = [this] { events += "end "; }};
  }
  std::size_t length = 0;
};

TEST(EndpointerTest, SpeechBetweenSilencesIsOneUtteranceWithItsLead) {
  Log log;
  srm::Endpointer endpointer({}, log.Events());
  auto sound = Sound(800, 20);
  Add(sound, Sound(700, 3000));
  Add(sound, Sound(900, 20));
  for (std::size_t at = 0; at < sound.size(); at += 37) {  // odd pieces
    endpointer.Feed(std::span(sound).subspan(at, std::min<std::size_t>(37, sound.size() - at)));
  }
  EXPECT_EQ(log.events, "begin end ");
  EXPECT_NEAR(static_cast<double>(log.length) / 16, 300 + 700 + 500, 25);
}

TEST(EndpointerTest, ClicksAndNoiseAreNoSpeech) {
  Log log;
  srm::Endpointer endpointer({}, log.Events());
  auto sound = Sound(500, 20);
  Add(sound, Sound(30, 8000));
  Add(sound, Sound(500, 20));
  Add(sound, Sound(20'000, 25));
  endpointer.Feed(sound);
  EXPECT_EQ(log.events, "");
}

TEST(EndpointerTest, APauseShorterThanTheSilenceIsPartOfTheUtterance) {
  Log log;
  srm::Endpointer endpointer({.silence = Millis(800)}, log.Events());
  auto sound = Sound(300, 20);
  Add(sound, Sound(500, 3000));
  Add(sound, Sound(700, 20));
  Add(sound, Sound(500, 3000));
  endpointer.Feed(sound);
  EXPECT_EQ(log.events, "begin ");
  endpointer.Finish();
  EXPECT_EQ(log.events, "begin end ");
}

TEST(EndpointerTest, AnEndlessSoundIsCut) {
  Log log;
  srm::Endpointer endpointer({.longest = Millis(2000)}, log.Events());
  endpointer.Feed(Sound(300, 20));
  endpointer.Feed(Sound(2500, 3000));
  EXPECT_TRUE(log.events.starts_with("begin end ")) << log.events;
}

TEST(EndpointerTest, AWholePhraseNeedsLessSilence) {
  Log log;
  std::vector<std::size_t> asked_at_ms;
  bool whole = false;
  auto events = log.Events();
  events.complete = [&] {
    asked_at_ms.push_back(log.length / srm::kFramesPerMs);
    return whole;
  };
  srm::Endpointer endpointer({.complete = Millis(200)}, events);
  endpointer.Feed(Sound(800, 20));
  endpointer.Feed(Sound(600, 3000));
  const std::size_t end_ms = log.length / srm::kFramesPerMs;
  endpointer.Feed(Sound(450, 20));
  ASSERT_EQ(asked_at_ms.size(), 6u) << "from 200 ms on each 50, up to 450";
  EXPECT_EQ(asked_at_ms[0], end_ms + 200);
  EXPECT_EQ(asked_at_ms[1], end_ms + 250);
  EXPECT_EQ(log.events, "begin ") << "what is not whole has the longer silence";
  endpointer.Feed(Sound(100, 20));
  EXPECT_EQ(log.events, "begin end ");
  whole = true;
  endpointer.Feed(Sound(600, 3000));
  endpointer.Feed(Sound(230, 20));
  EXPECT_EQ(log.events, "begin end begin end ");
}

/// Hears the same text in everything; notes the grammars it is given.
class ToldDecoder final : public srm::SpeechDecoder {
 public:
  explicit ToldDecoder(std::string& text, double& fit, std::vector<std::string>& calls)
      : text_(text), fit_(fit), calls_(calls) {}
  vm::Result<void> Use(const std::vector<const ear::Grammar*>& grammars) override {
    calls_.push_back("use " + std::to_string(grammars.size()));
    return {};
  }
  vm::Result<void> Pronounce(const std::string& word, const std::string& spoken) override {
    if (spoken == "bad") return vm::Fail(vm::Errc::kBadValue, "no");
    calls_.push_back(word + "=" + spoken);
    return {};
  }
  void Begin() override {
    calls_.push_back("begin");
    fed_ = 0;
  }
  void Feed(std::span<const std::int16_t> samples) override { fed_ += samples.size(); }
  void set_most(std::size_t most) override { most_ = most; }
  std::string Partial() override { return text_.substr(0, text_.find(' ')); }
  srm::Hypothesis End() override {
    calls_.push_back("end " + std::to_string(fed_ / 1600));
    return {.text = text_,
            .words = {{text_, Millis(300), Millis(800)}},
            .fit = fit_,
            .confidence = srm::ConfidenceOf(fit_),
            .others = most_ > 1 ? others_ : std::vector<srm::Alternative>()};
  }

 private:
  std::string& text_;
  double& fit_;
  std::vector<std::string>& calls_;
  const std::vector<srm::Alternative> others_ = {{"yes", 0.4}, {"what nobody asked for", 0.3}};
  std::size_t most_ = 1;
  std::size_t fed_ = 0;
};

class RecognizerTest : public testing::Test {
 protected:
  RecognizerTest() {
    sound_ = Sound(800, 20);
    Add(sound_, Sound(700, 3000));
    Add(sound_, Sound(300, 20));
    module_ = std::make_unique<srm::RecognizerModule>(
        clock_,
        srm::RecognizerModule::Options{
            .module_version = "test",
            .read_file = [](const std::string& path) -> vm::Result<std::string> {
              if (path == "g.jsgf") return "#JSGF V1.0;\ngrammar g;\npublic <a> = yes {Y};";
              return vm::Fail(vm::Errc::kUnavailable, "cannot read '" + path + "'");
            },
            .open_decoder = [this]() -> vm::Result<std::unique_ptr<srm::SpeechDecoder>> {
              on_load_();
              return std::make_unique<ToldDecoder>(text_, fit_, calls_);
            },
            .open_spotter = []() -> vm::Result<std::unique_ptr<srm::KeywordSpotter>> {
              return vm::Fail(vm::Errc::kUnavailable, "none");
            },
            .open_source =
                [this](const std::string& name) -> vm::Result<std::unique_ptr<sound::AudioSource>> {
              if (name != "wav:a") return vm::Fail(vm::Errc::kBadValue, "no source " + name);
              return std::make_unique<sound::RecordedSource>(clock_, sound_);
            }});
    module_->slots().set_output([this](vm::PeerId, const vm::Message& message) {
      said_.push_back(vm::FormatMessage(message));
    });
    module_->slots().set_on_error([this](vm::PeerId, const std::string&, const vm::Error& error) {
      errors_.push_back(vm::FormatError(error));
    });
  }
  void Tell(const std::string& line) { module_->slots().HandleLine(line, 1); }
  void UntilIdle() { clock_.RunUntilIdle(clock_.Now() + std::chrono::hours(1)); }
  using Lines = std::vector<std::string>;
  Lines Said() { return std::exchange(said_, {}); }

  vm::VirtualScheduler clock_;
  std::vector<std::int16_t> sound_;
  std::string text_ = "yes please";
  double fit_ = 0;
  std::function<void()> on_load_ = [] {};
  Lines calls_, said_, errors_;
  std::unique_ptr<srm::RecognizerModule> module_;
};

TEST_F(RecognizerTest, SpeechBecomesPartialAndFinalResultsWithTheirMeaning) {
  Tell("set Grammar.load = answer yes [please] {YES} | no {NO}");
  Tell("set Grammar = answer");
  Tell("set Input = wav:a");
  Tell("set Run = START");
  UntilIdle();
  EXPECT_EQ(Said(), (Lines{"rep Grammar = answer", "rep Input = wav:a", "rep Run = START",
                           "rep Listen.stat = LISTENING", "rep Listen.stat = SPEECH",
                           "rep Result.partial = yes", "rep Result.grammar = answer",
                           "rep Result.tag = YES", "rep Result = yes please",
                           "rep Listen.stat = LISTENING", "rep Input = NONE"}));
  EXPECT_EQ(errors_, Lines{});
  EXPECT_EQ(module_->slots().Value("Result.words").substr(0, 11), "yes please[");
  EXPECT_FALSE(module_->Busy());
}

TEST_F(RecognizerTest, ItSaysThatItListensOnceItsEngineIsLoaded) {
  on_load_ = [this] { said_.push_back("loaded"); };
  Tell("set Input = wav:a");
  Tell("set Run = START");
  EXPECT_EQ(Said(), (Lines{"rep Input = wav:a", "rep Run = START", "loaded",
                           "rep Listen.stat = LISTENING"}));
}

TEST_F(RecognizerTest, AWholePhraseEndsSoonerAndOneThatGoesOnDoesNot) {
  const auto end_ms = [this](const std::string& text) {
    text_ = text;
    Tell("set Input = wav:a");
    UntilIdle();
    return std::stol(calls_.back().substr(4)) * 100;  // "end" and the tenths of a second fed
  };
  sound_ = Sound(800, 20);
  Add(sound_, Sound(700, 3000));
  Add(sound_, Sound(800, 20));
  Tell("set Run = START");
  const long usual = end_ms("tomorrow");
  Tell("set Listen.complete = 200");
  EXPECT_EQ(end_ms("tomorrow"), usual - 300);
  EXPECT_EQ(end_ms("the"), usual) << "more is said behind it";
  Tell("set Grammar.load = answer yes | no");
  Tell("set Grammar = answer");
  EXPECT_EQ(end_ms("yes"), usual - 300);
  EXPECT_EQ(end_ms("tomorrow"), usual) << "no phrase of the grammar";
  Tell("set Listen.complete = 0");
  EXPECT_EQ(end_ms("yes"), usual);
}

TEST_F(RecognizerTest, WhatFitsBadlyOrNotAtAllIsNoMatch) {
  Tell("set Grammar.load = answer yes please");
  Tell("set Grammar = answer");
  fit_ = -30;
  Tell("set Input = wav:a");
  Tell("set Run = START");
  UntilIdle();
  EXPECT_EQ(Said()[6], "rep NoMatch = yes please");
  fit_ = 0;
  text_ = "something else";
  Tell("set Input = wav:a");
  UntilIdle();
  EXPECT_EQ(Said()[3], "rep NoMatch = something else");
}

TEST_F(RecognizerTest, OtherHypothesesThatFitAGrammarAreCandidatesBehindTheBest) {
  Tell("set Grammar.load = g yes please {Y} | yes {MAYBE}");
  Tell("set Grammar = g");
  Tell("set Listen.nbest = 3");
  Tell("set Input = wav:a");
  Tell("set Run = START");
  UntilIdle();
  EXPECT_EQ(module_->slots().Value("Result"), "yes please");
  const std::string best = std::string(module_->slots().Value("Result.nbest"));
  EXPECT_TRUE(best.ends_with(" yes please | 0.40 yes")) << best;
  EXPECT_NE(module_->slots()
                .Value("Result.xml")
                .find("<candidate rank=\"2\" confidence=\"0.4\" "
                      "grammar=\"g\" tag=\"MAYBE\">yes<"),
            std::string::npos);
  EXPECT_EQ(module_->slots().Value("Result.wordconfidence"), "yes please 1.00");
}

TEST_F(RecognizerTest, AGrammarSwitchedInTheMiddleHearsTheUtteranceFromItsBeginning) {
  Tell("set Grammar.load = a yes");
  Tell("set Grammar.load = b yes please {B}");
  Tell("set Grammar = a");
  Tell("set Input = wav:a");
  Tell("set Run = START");
  clock_.RunUntil(vm::Time(1'300'000));
  Tell("set Grammar = a b");
  UntilIdle();
  EXPECT_EQ(module_->slots().Value("Result"), "yes please");
  EXPECT_EQ(module_->slots().Value("Result.grammar"), "b");
  EXPECT_EQ(calls_[0], "use 1");
  EXPECT_EQ(calls_[3], "use 2");
  // The second pass had everything: lead, speech and silence.
  EXPECT_EQ(calls_.back(), "end 15");
}

TEST_F(RecognizerTest, SilenceIsNoInput) {
  sound_ = Sound(3000, 20);
  Tell("set Listen.timeout = 2000");
  Tell("set Input = wav:a");
  Tell("set Run = START");
  UntilIdle();
  EXPECT_EQ(Said(), (Lines{"rep Input = wav:a", "rep Run = START", "rep Listen.stat = LISTENING",
                           "rep NoInput = 2000", "rep Input = NONE"}));
}

TEST_F(RecognizerTest, WhileTheAgentSpeaksItsVoiceIsNoInputUnlessTheEchoIsSeenTo) {
  Tell("set Agent = SPEAKING");
  Tell("set Input = wav:a");
  Tell("set Run = START");
  Tell("set Agent = SPEAKING");
  UntilIdle();
  for (const std::string& line : Said()) EXPECT_EQ(line.find("Result"), std::string::npos) << line;
  Tell("set Agent.echo = OPEN");
  Tell("set Input = wav:a");
  UntilIdle();
  const Lines said = Said();
  EXPECT_NE(
      std::find_if(said.begin(), said.end(),
                   [](const std::string& line) { return line.starts_with("rep BargeIn = 8"); }),
      said.end());
}

TEST(EchoCancellerTest, TheAgentsVoiceGoesAndSomebodyElsesStays) {
  // The room: the voice 30 ms later, softer, with a second path.
  const auto voice = Sound(12'000, 6000);
  std::vector<std::int16_t> echo(voice.size());
  for (std::size_t i = 1200; i < echo.size(); ++i) {
    echo[i] = static_cast<std::int16_t>(0.4 * voice[i - 480] - 0.2 * voice[i - 1200]);
  }
  const auto other = Sound(1000, 2500);
  for (std::size_t i = 0; i < other.size(); ++i) {
    auto& heard = echo[10'000 * srm::kFramesPerMs + i];
    heard = static_cast<std::int16_t>(heard + other[other.size() - 1 - i]);
  }
  srm::EchoCanceller canceller;
  std::vector<std::int16_t> clean;
  for (std::size_t at = 0; at < echo.size(); at += 320) {
    canceller.Play(std::span(voice).subspan(at, 320));
    Add(clean, canceller.Clean(std::span(echo).subspan(at, 320)));
  }
  const auto level = [](std::span<const std::int16_t> samples) {
    double power = 0;
    for (const auto s : samples) power += static_cast<double>(s) * s;
    return 10 * std::log10(power / static_cast<double>(samples.size()) + 1);
  };
  const auto part = [&](std::span<const std::int16_t> samples, std::size_t ms) {
    return level(samples.subspan(ms * srm::kFramesPerMs, 900 * srm::kFramesPerMs));
  };
  ASSERT_GT(clean.size(), echo.size() - 512);
  const double gone = part(echo, 8000) - part(clean, 8000);
  std::printf("echo: %.0f dB less\n", gone);
  EXPECT_GT(gone, 25);
  EXPECT_GT(part(clean, 10'050), part(clean, 8000) + 15);
}

TEST_F(RecognizerTest, TypedTextIsRecognizedLikeTheStubs) {
  Tell("set Grammar.file = g g.jsgf");
  Tell("set Grammar = g");
  Tell("set#1 Input.text = yes");
  Tell("set Run = START");
  Said();
  Tell("set#2 Input.text = Yes!");
  EXPECT_EQ(Said(),
            (Lines{"rep Listen.stat = SPEECH", "rep Result.grammar = g", "rep Result.tag = Y",
                   "rep Result = Yes!", "rep#2 Input.text = Yes!", "rep Listen.stat = LISTENING"}));
  EXPECT_EQ(errors_, (Lines{"BUSY not listening; set Run = START first"}));
}

TEST_F(RecognizerTest, BadRequestsAreRefusedAndChangeNothing) {
  for (const char* line :
       {"set Grammar = nothing", "set Grammar.load = x (", "set Grammar.load = NONE a",
        "set Grammar.file = x missing", "set Grammar.drop = x", "set Input = wav:b",
        "set Listen.threshold = 2", "set Grammar.word = x bad", "set Spot = stop"}) {
    errors_.clear();
    Tell(line);
    EXPECT_EQ(errors_.size(), 1u) << line;
  }
  EXPECT_EQ(module_->slots().Value("Grammar"), "NONE");
  EXPECT_EQ(module_->slots().Value("Input"), "NONE");
}

TEST_F(RecognizerTest, WhatWasSaidIsKeptWithItsLeadAndItsFinalSilence) {
  support::TempDir folder;
  Tell("set Listen.keep = " + folder.path());
  Tell("set Input = wav:a");
  Tell("set Run = START");
  UntilIdle();
  const std::string told = module_->slots().Value("Result.sound");
  const std::string file = folder / "utterance-1.wav";
  const auto ms = static_cast<std::size_t>(std::atoi(told.c_str()));
  EXPECT_NEAR(static_cast<double>(ms), 300 + 700 + 500, 25);
  EXPECT_EQ(told, std::to_string(ms) + " " + std::to_string(44 + ms * 32) + " WHOLE " + file);
  const auto kept = sound::ReadSound(file);
  ASSERT_TRUE(kept) << kept.error().text;
  EXPECT_NE(std::search(sound_.begin(), sound_.end(), kept->begin(), kept->begin() + 12'000),
            sound_.end());
}

TEST_F(RecognizerTest, WhatWasSaidIsNotWrittenToANamedPipe) {
  support::TempDir folder;
  const std::string pipe = folder / "utterance-1.wav";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  Tell("set Listen.keep = " + folder.path());
  Tell("set Input = wav:a");
  Tell("set Run = START");
  UntilIdle();
  EXPECT_EQ(errors_, (Lines{"ACCESS '" + pipe + "' is not a regular file"}));
}

TEST_F(RecognizerTest, ALongUtteranceIsCutWhereItIsTold) {
  support::TempDir folder;
  Tell("set Listen.keep = " + folder.path());
  Tell("set Listen.longest = 700");
  Tell("set Input = wav:a");
  Tell("set Run = START");
  UntilIdle();
  EXPECT_TRUE(std::filesystem::exists(folder / "utterance-1.wav"));
  const Lines said = Said();
  EXPECT_NE(std::find(said.begin(), said.end(),
                      "rep Result.sound = 700 22444 CUT " + (folder / "utterance-1.wav")),
            said.end());
}

TEST_F(RecognizerTest, AnUtteranceCanBeEndedFromOutside) {
  Tell("set Input = wav:a");
  Tell("set Run = START");
  clock_.RunUntil(vm::Time(1'300'000));
  Said();
  Tell("set Listen.end = NOW");
  EXPECT_EQ(Said()[2], "rep Result = yes please");
}

TEST_F(RecognizerTest, StopDropsWhatIsBeingHeard) {
  Tell("set Input = wav:a");
  Tell("set Run = START");
  clock_.RunUntil(vm::Time(1'300'000));
  Tell("set Run = STOP");
  Said();
  UntilIdle();
  EXPECT_EQ(Said(), Lines{});
  EXPECT_EQ(module_->slots().Value("Listen.stat"), "OFF");
}

}  // namespace
