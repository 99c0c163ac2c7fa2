// The module on a virtual clock: sound in, frames out, exact and the same each time.

#include "vdm/core/movement_module.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "fsm/rig/face_state.h"
#include "vm_protocol/core/start_time.h"

namespace vdm {
namespace {

using namespace std::chrono_literals;

/// A voice of a kind: a buzz of 120 Hz through three formants of "a", 5 times a second; silence
/// around. What the shipped network makes of it is no matter of these tests but that it opens.
std::vector<std::int16_t> Voice(std::size_t ms) {
  std::vector<std::int16_t> sound(16 * ms);
  for (std::size_t i = 0; i < sound.size(); ++i) {
    const double t = static_cast<double>(i) / 16000;
    double x = 0;
    for (int k = 1; k <= 30; ++k) {
      const double hz = 120 * k;
      double size = 0;
      for (const double formant : {700.0, 1200.0, 2600.0})
        size += 1 / (1 + std::pow((hz - formant) / 90, 2));
      x += size * std::sin(6.2831853 * hz * t);
    }
    const double syllable = std::pow(std::sin(3.14159265 * t * 4), 2);
    sound[i] = static_cast<std::int16_t>(std::lround(4000 * syllable * x));
  }
  return sound;
}

/// A source that gives what the test gives.
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

class MovementTest : public testing::Test {
 protected:
  MovementTest() { Make(); }
  void Make() {
    module_ = std::make_unique<MovementModule>(
        clock_,
        MovementModule::Options{
            .module_version = "test",
            .open_source =
                [this](const std::string& name) -> vm::Result<std::unique_ptr<sound::AudioSource>> {
              if (name == "wav:voice")
                return std::make_unique<sound::RecordedSource>(clock_, Voice(2000));
              if (name == "raw:hand") return std::make_unique<HandSource>(live_);
              return vm::Fail(vm::Errc::kUnavailable, "there is no microphone");
            },
            .clock_is_shared = [this] { return clock_is_shared_; },
            .read_words =
                [this](const std::string& path) {
                  asked_for_ = path;
                  return words_;
                },
            .phones = phones_,
            .words = word_net_,
            .mel = &ShippedNet(FeatureKind::kMel),
            .cepstra = &ShippedNet(FeatureKind::kCepstra),
            .head = &ShippedHeadNet(false),
            .head_by_prosody = &ShippedHeadNet(true),
            .emotions = &ShippedEmotions(),
            .speakers_folder = speakers_folder_});
    module_->slots().set_output([this](vm::PeerId, const vm::Message& message) {
      said_.push_back({clock_.Now(), message});
    });
    module_->slots().set_on_error([this](vm::PeerId, const std::string&, const vm::Error& error) {
      errors_.push_back(vm::FormatError(error));
    });
  }
  void Tell(const std::string& line) { module_->slots().HandleLine(line, 1); }
  void Run(vm::Time until) { clock_.RunUntil(until); }
  struct Frame {
    vm::Time told, at;
    std::vector<double> numbers;
  };
  /// The frames told to the face, with the instants they are for.
  std::vector<Frame> Frames() const {
    std::vector<Frame> frames;
    vm::Time start{0};
    for (const auto& [told, message] : said_) {
      if (message.slot == "MouthFrame.start") start = vm::ParseStartTime(message.value)->time;
      if (message.slot != "MouthFrame") continue;
      EXPECT_EQ(message.to, std::vector<std::string>{"FSM"});
      std::istringstream words(message.value);
      Frame frame{told, vm::Time(0), {}};
      for (double number = 0; words >> number;) frame.numbers.push_back(number);
      frame.at = start + vm::Time(static_cast<long>(frame.numbers[0] * 1000));
      frames.push_back(frame);
    }
    return frames;
  }
  std::string AllSaid() const {
    std::string all;
    for (const auto& [told, message] : said_)
      all += vm::FormatMs(told) + " " + vm::FormatMessage(message) + "\n";
    return all;
  }
  std::size_t Count(const std::string& line) const {
    return static_cast<std::size_t>(std::ranges::count_if(
        said_, [&](const auto& one) { return vm::FormatMessage(one.second) == line; }));
  }

  vm::VirtualScheduler clock_;
  const MouthNet* phones_ = nullptr;
  const MouthNet* word_net_ = nullptr;
  std::string speakers_folder_;
  bool clock_is_shared_ = true;
  RecordedMouth words_;
  std::string asked_for_;  // the recording whose words were read
  sound::AudioSource::Events live_;
  std::vector<std::pair<vm::Time, vm::Message>> said_;
  std::vector<std::string> errors_;
  std::unique_ptr<MovementModule> module_;
};

TEST_F(MovementTest, WordsKnownOfARecordingMoveTheMouth) {
  // A jaw that drops wider than the network says of any sound.
  MouthFrame open;
  open.seal = 0;
  open.mouth[fsm::kJawY] = 30;
  words_.text = "never";
  words_.instants.assign(200, {.frame = open, .trust = 1});
  const auto widest = [this] {
    double jaw = 0;
    for (const Frame& frame : Frames()) jaw = std::max(jaw, frame.numbers.at(1 + fsm::kJawY));
    return jaw;
  };
  Tell("set Input = wav:voice");
  Tell("prop Mouth.words = AutoOutput");
  Tell("set Run = START");
  Run(10s);
  EXPECT_EQ(asked_for_, "voice");
  EXPECT_EQ(Count("rep Mouth.words = never"), 1U) << AllSaid();
  EXPECT_NEAR(widest(), 30, 2);
  said_.clear();
  words_ = {};
  Tell("set Input = wav:voice");
  Run(20s);
  EXPECT_LT(widest(), 15);
}

TEST_F(MovementTest, WordsAreNotReadWhereSomebodyWaitsOrANetworkIsAskedFor) {
  clock_is_shared_ = false;
  Tell("set Input = wav:voice");
  Tell("set Run = START");
  EXPECT_EQ(asked_for_, "");
  Tell("set Run = STOP");
  clock_is_shared_ = true;
  Tell("set Mouth.mode = MEL");
  Tell("set Input = wav:voice");
  Tell("set Run = START");
  EXPECT_EQ(asked_for_, "");
}

TEST_F(MovementTest, ARecordingMovesTheFaceAndEndsAtRest) {
  Tell("set Input = wav:voice");
  Tell("set Run = START");
  EXPECT_TRUE(module_->Busy());
  Run(10s);
  EXPECT_FALSE(module_->Busy());
  EXPECT_EQ(clock_.pending(), 0U);
  const auto frames = Frames();
  ASSERT_GT(frames.size(), 50U);
  double widest = 0;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    EXPECT_EQ(frames[i].numbers.size(), 20U);
    EXPECT_LT(frames[i].told, frames[i].at) << "a frame was told after its time";
    widest = std::max(widest, frames[i].numbers[12]);
  }
  EXPECT_GT(widest, 3);                     // degrees of the jaw: an "a"
  EXPECT_EQ(frames.back().numbers[18], 1);  // sealed
  EXPECT_GT(frames.front().at, 0ms);
  EXPECT_LT(frames.back().at, 2s + 100ms + 700ms);
  EXPECT_EQ(Count("rep Input = NONE"), 1U);
  EXPECT_GE(Count("rep Mouth.stat = MOVING"), 1U);
}

TEST_F(MovementTest, TheSameSoundGivesTheSameBytes) {
  const auto run = [this] {
    said_.clear();
    clock_ = {};
    Make();
    Tell("set Input = wav:voice");
    Tell("set Run = START");
    Run(10s);
    return AllSaid();
  };
  const std::string first = run();
  EXPECT_GT(first.size(), 1000U);
  EXPECT_EQ(run(), first);
}

TEST_F(MovementTest, DelayMovesTheFramesAndTooLittleIsRefused) {
  const auto first_at = [this](const char* delay) {
    said_.clear();
    module_.reset();
    clock_ = {};
    Make();
    Tell(std::string("set Delay = ") + delay);
    Tell("set Input = wav:voice");
    Tell("set Run = START");
    Run(10s);
    return Frames().front().at;
  };
  EXPECT_EQ(first_at("400") - first_at("150"), 250ms);
  Tell("set Delay = 20");
  ASSERT_EQ(errors_.size(), 1U);
  EXPECT_EQ(errors_[0],
            "BAD_VALUE 20 ms found, at least 100 expected: so much more has to be heard before the "
            "mouth is known");
}

TEST_F(MovementTest, AMissingSourceIsOneErrorAndTheNextWorks) {
  Tell("set Run = START");
  Tell("set Input = portaudio");
  EXPECT_EQ(errors_, std::vector<std::string>{"UNAVAILABLE there is no microphone"});
  EXPECT_EQ(module_->slots().Value("Input"), "NONE");
  Tell("set Input = wav:voice");
  Run(10s);
  EXPECT_GT(Frames().size(), 50U);
  EXPECT_EQ(errors_.size(), 1U);
}

TEST_F(MovementTest, AStreamThatStallsRestsWithOneErrorAndGoesOnWhenSoundComes) {
  Tell("set Input = raw:hand");
  Tell("set Run = START");
  const auto voice = Voice(1000);
  const auto play = [&] {
    for (std::size_t at = 0; at < voice.size(); at += 320) {
      Run(clock_.Now() + 20ms);
      live_.sound(std::span(voice).subspan(at, 320));
    }
  };
  play();
  EXPECT_EQ(module_->slots().Value("Mouth.stat"), "MOVING");
  Run(clock_.Now() + 10s);
  EXPECT_EQ(errors_.size(), 1U);
  EXPECT_NE(errors_[0].find("no sound has come from 'raw:hand' for 1000 ms"), std::string::npos);
  EXPECT_EQ(module_->slots().Value("Mouth.stat"), "LISTENING");
  EXPECT_EQ(Frames().back().numbers[18], 1);
  const std::size_t before = Frames().size();
  play();
  EXPECT_GT(Frames().size(), before + 20);
  EXPECT_EQ(errors_.size(), 1U);
  live_.failed({vm::Errc::kUnavailable, "the microphone gives no sound any more", 0});
  Run(clock_.Now() + 1s);
  EXPECT_EQ(errors_.size(), 2U);
  EXPECT_EQ(module_->slots().Value("Input"), "NONE");
  EXPECT_EQ(clock_.pending(), 0U);
}

TEST_F(MovementTest, StopInTheMiddleClosesTheMouth) {
  Tell("set Input = wav:voice");
  Tell("set Run = START");
  Run(800ms);
  ASSERT_EQ(module_->slots().Value("Mouth.stat"), "MOVING");
  Tell("set Run = STOP");
  EXPECT_EQ(Count("to @FSM set MouthFrame.start = STOP"), 1U);
  EXPECT_EQ(module_->slots().Value("Mouth.stat"), "OFF");
  const std::size_t before = Frames().size();
  Run(10s);
  EXPECT_EQ(Frames().size(), before);
  EXPECT_EQ(clock_.pending(), 0U);
}

TEST_F(MovementTest, ModesAndReceiversCanBeChosen) {
  Tell("set Mouth.mode = CEPSTRA");
  Tell("set Mouth.to = LADY");
  Tell("prop Mouth = AutoOutput");
  Tell("prop Mouth.sounds = AutoOutput");
  Tell("set Input = wav:voice");
  Tell("set Run = START");
  Run(10s);
  std::size_t to_lady = 0, reports = 0, sounds = 0;
  for (const auto& [told, message] : said_) {
    to_lady += message.slot == "MouthFrame" && message.to == std::vector<std::string>{"LADY"};
    reports += message.slot == "Mouth";
    sounds += message.slot == "Mouth.sounds";
  }
  EXPECT_GT(to_lady, 20U);
  EXPECT_EQ(to_lady, reports);
  EXPECT_GT(sounds, 20U);
  Tell("set Mouth.to = no/such name");
  EXPECT_EQ(errors_.size(), 1U);
}

TEST_F(MovementTest, TheHeadMovesWithTheVoiceWhereItIsWanted) {
  const auto run = [this](const std::string& head) {
    said_.clear();
    module_.reset();
    clock_ = {};
    Make();
    Tell("set Head.auto = " + head);
    Tell("set Input = wav:voice");
    Tell("set Run = START");
    Run(10s);
    return Frames();
  };
  const auto without = run("OFF");
  for (const std::string mode : {"ON", "PROSODY"}) {
    const auto frames = run(mode);
    ASSERT_EQ(frames.size(), without.size()) << mode;
    double widest = 0, fastest = 0;
    for (std::size_t i = 0; i < frames.size(); ++i) {
      ASSERT_EQ(frames[i].numbers.size(), 24U);
      EXPECT_TRUE(std::ranges::equal(without[i].numbers, std::span(frames[i].numbers).first(20)))
          << "the mouth is another with a head, at " << frames[i].at.count();
      for (std::size_t k = 20; k < 23; ++k) {
        widest = std::max(widest, std::abs(frames[i].numbers[k]));
        if (i > 0) {
          fastest =
              std::max(fastest, std::abs(frames[i].numbers[k] - frames[i - 1].numbers[k]) / 0.02);
        }
      }
    }
    EXPECT_GT(widest, 0.5) << mode;
    EXPECT_LT(widest, 15) << mode;
    EXPECT_LT(fastest, 80) << mode << ": degrees a second";
  }
}

TEST_F(MovementTest, HeadAndEmotionAreTheSameEachTime) {
  const auto run = [this] {
    said_.clear();
    module_.reset();
    clock_ = {};
    Make();
    for (const char* line :
         {"set Head.auto = ON", "set Emotion.auto = ON", "set Delay = 160",
          "prop Prosody = AutoOutput", "set Input = wav:voice", "set Run = START"}) {
      Tell(line);
    }
    Run(10s);
    return AllSaid();
  };
  const std::string first = run();
  EXPECT_GT(first.size(), 3000U);
  EXPECT_NE(first.find("rep Prosody = "), std::string::npos);
  EXPECT_EQ(run(), first);
}

TEST_F(MovementTest, ALongerDelayMakesUpForALateHead) {
  const auto run = [this](const std::string& delay) {
    said_.clear();
    module_.reset();
    clock_ = {};
    Make();
    Tell("set Head.auto = ON");
    Tell("set Delay = " + delay);
    Tell("set Input = wav:voice");
    Tell("set Run = START");
    Run(10s);
    return Frames();
  };
  // From the mouth's frames on the head is by three of 20 ms nearer to them; both runs are counted
  // from their first frames.
  const auto late = run("100"), in_time = run("160"), more = run("300");
  ASSERT_GT(late.size(), 60U);
  for (std::size_t i = 10; i < 50; ++i) {
    EXPECT_EQ(in_time[i].numbers[12], late[i].numbers[12]);
    EXPECT_NEAR(in_time[i].numbers[20], late[i + 3].numbers[20], 0.011) << i;
    EXPECT_EQ(more[i].numbers[20], in_time[i].numbers[20]);
  }
  for (const auto& frame : in_time) EXPECT_LT(frame.told, frame.at);
}

TEST_F(MovementTest, AfterAHoleInTheSoundTheHeadTakesOtherPoses) {
  Tell("set Head.auto = ON");
  Tell("set Input = raw:hand");
  Tell("set Run = START");
  const auto voice = Voice(2000);
  const auto turns = [&] {
    const std::size_t before = Frames().size();
    for (std::size_t at = 0; at < voice.size(); at += 320) {
      Run(clock_.Now() + 20ms);
      live_.sound(std::span(voice).subspan(at, 320));
    }
    std::vector<double> right;
    for (const Frame& frame : Frames()) right.push_back(frame.numbers[21]);
    right.erase(right.begin(), right.begin() + static_cast<std::ptrdiff_t>(before));
    Run(clock_.Now() + 900ms);
    return right;
  };
  const auto first = turns(), second = turns();
  ASSERT_GT(std::min(first.size(), second.size()), 60U);
  EXPECT_GT(std::abs(first[60] - second[60]), 0.1);
}

TEST_F(MovementTest, InNoiseAndSilenceTheHeadRestsAndNoEmotionIsClaimed) {
  for (const char* line :
       {"set Head.auto = ON", "set Emotion.auto = ON", "set Input = raw:hand", "set Run = START"}) {
    Tell(line);
  }
  std::uint32_t random = 1;
  std::vector<std::int16_t> piece(320);
  for (int n = 0; n < 500; ++n) {
    const int size = n < 250 ? 0 : 3000;
    for (auto& sample : piece) {
      random = random * 1664525 + 1013904223;
      sample =
          static_cast<std::int16_t>(size * (static_cast<int>(random >> 16 & 1023) - 512) / 512);
    }
    Run(clock_.Now() + 20ms);
    live_.sound(piece);
  }
  for (const Frame& frame : Frames()) {
    for (std::size_t k = 20; k < 24; ++k) EXPECT_EQ(frame.numbers[k], 0);
  }
  for (const auto& [told, message] : said_) {
    EXPECT_NE(message.slot, "Mood");
    EXPECT_TRUE(message.slot != "Emotion" || message.value == "NONE") << message.value;
  }
}

TEST_F(MovementTest, SilenceAndOffTellNothing) {
  Tell("set Input = raw:hand");
  Tell("set Run = START");
  const std::vector<std::int16_t> silence(16000);
  live_.sound(silence);
  Tell("set Mouth.mode = OFF");
  live_.sound(Voice(1000));
  EXPECT_TRUE(Frames().empty());
}

TEST_F(MovementTest, WithoutThePhoneModelTheMelNetworkWorksAndPhonesAreRefused) {
  Tell("inq Mouth.net");
  EXPECT_EQ(Count("rep Mouth.net = MEL"), 1U);
  Tell("set Mouth.mode = PHONES");
  Tell("set Mouth.mode = WORDS");
  ASSERT_EQ(errors_.size(), 2U);
  Tell("set Mouth.mode = CEPSTRA");
  Tell("inq Mouth.net");
  EXPECT_EQ(Count("rep Mouth.net = CEPSTRA"), 1U);
  Tell("set Mouth.mode = BEST");
  Tell("inq Mouth.net");
  EXPECT_EQ(Count("rep Mouth.net = MEL"), 2U);
}

TEST_F(MovementTest, TheNetworkOfWordsIsHeardBesideThatOfPhones) {
  // Two that hear the same here; the second is sure that the lips are closed.
  phones_ = &ShippedNet(FeatureKind::kMel);
  MouthNet closed = *phones_;
  closed.net.layers.back().biases[static_cast<Eigen::Index>(closed.closure_row())] = 100;
  word_net_ = &closed;
  Make();
  Tell("inq Mouth.net");
  EXPECT_EQ(Count("rep Mouth.net = WORDS"), 1U);
  const auto open = [this](const std::string& mode) {
    said_.clear();
    Tell("set Mouth.mode = " + mode);
    Tell("set Input = wav:voice");
    Tell("set Run = START");
    Run(clock_.Now() + 10s);
    const auto frames = Frames();
    return std::ranges::count_if(frames, [](const Frame& f) { return f.numbers[18] < 0.5; });
  };
  EXPECT_GT(open("PHONES"), 10);
  EXPECT_EQ(open("WORDS"), 0);
  EXPECT_EQ(open("BEST"), 0);
  module_.reset();
}

TEST_F(MovementTest, SpeakersAreKeptByNameInTheFolderGivenAndNowhereElse) {
  const auto folder = std::filesystem::path(testing::TempDir()) / "vdm_speakers";
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "anna.speaker") << "warp 1.10\n";
  std::ofstream(folder / "bad.speaker") << "warp 9\n";
  speakers_folder_ = folder;
  Make();
  Tell("set Input = wav:voice");
  Tell("set Run = START");
  Run(10s);
  const auto widest = [this] {
    double most = 0;
    for (const Frame& frame : Frames()) most = std::max(most, frame.numbers[12]);
    return most;
  };
  const double before = widest();
  said_.clear();
  Tell("set Speaker = anna");
  Tell("set Input = wav:voice");
  Run(20s);
  EXPECT_NE(widest(), before) << "the vocal tract changed nothing";
  EXPECT_TRUE(errors_.empty());
  for (const char* name : {"nobody", "../vdm_speakers/anna", "bad"}) {
    Tell(std::string("set Speaker = ") + name);
  }
  Tell("set Speaker.learn = ../evil");
  EXPECT_EQ(errors_.size(), 4U);
  std::filesystem::remove_all(folder);
}

TEST_F(MovementTest, WhoSaysNoVowelsIsNotMet) {
  Tell("set Speaker.learn = anna");
  Tell("set Input = wav:voice");  // a stretch for each syllable, more than five
  Tell("set Run = START");
  Run(10s);
  EXPECT_EQ(Count("rep Speaker.learn = NONE"), 1U);
  ASSERT_EQ(errors_.size(), 1U);
  EXPECT_NE(errors_[0].find("stretches of"), std::string::npos) << errors_[0];
  Tell("set Speaker = anna");
  EXPECT_EQ(errors_.size(), 2U);
}

}  // namespace
}  // namespace vdm
