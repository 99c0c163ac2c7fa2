#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include "fsm/app/capture.h"
#include "tests/fsm/app_support.h"

namespace fsm {
namespace {

using namespace std::chrono_literals;

/// A clock that somebody else moves, also while a timer runs: as real time does.
class LateClock final : public vm::Scheduler {
 public:
  vm::Time Now() const override { return now; }
  vm::TimerId At(vm::Time when, std::function<void()> action) override {
    due = when;
    action_ = std::move(action);
    return 1;
  }
  void Cancel(vm::TimerId) override { action_ = nullptr; }
  void RunNext() {
    now = std::max(now, due);
    std::exchange(action_, nullptr)();
  }

  vm::Time now{0};
  vm::Time due{0};

 private:
  std::function<void()> action_;
};

struct FilmTest : testing::Test {
  FilmTest()
      : film(
            clock, world, world.files,
            [this](long number, vm::Time at) {
              drawn.emplace_back(number, at);
              clock.now += drawing_takes;
              return world.Draw(FaceState{}, Scene{}, nullptr);
            },
            [this](const vm::Error& error) { failure = error.text; }) {}

  LateClock clock;
  FakeWorld world;
  std::vector<std::pair<long, vm::Time>> drawn;
  vm::Time drawing_takes{0};
  std::string failure;
  FilmRecorder film;
};

TEST_F(FilmTest, FramesStandAtExactInstantsHoweverLongItIs) {
  ASSERT_TRUE(film.Start("a.mp4", 30));
  for (int i = 0; i < 301; ++i) clock.RunNext();
  EXPECT_EQ(drawn[1].second, vm::Time(33333us));
  EXPECT_EQ(drawn[300].second, vm::Time(10s));
  EXPECT_EQ(film.Stop("")->repeated, 0);
}

TEST_F(FilmTest, SlowDrawingRepeatsFramesSoThatTheFilmKeepsStep) {
  ASSERT_TRUE(film.Start("a.mp4", 30));
  drawing_takes = 90ms;
  while (clock.now < 3s) clock.RunNext();
  const auto report = film.Stop("voice.wav");
  ASSERT_TRUE(report);
  EXPECT_NEAR(static_cast<double>(report->frames), 3.0 * 30, 4);
  EXPECT_GT(report->repeated, 50);
  EXPECT_EQ(world.films["a.mp4"].jaws.size(), static_cast<std::size_t>(report->frames));
  EXPECT_EQ(world.films["a.mp4"].sound, "voice.wav");
}

TEST_F(FilmTest, VerySlowDrawingStillShowsSomethingNewAndLetsInputIn) {
  ASSERT_TRUE(film.Start("a.mp4", 30));
  drawing_takes = 1s;
  for (int i = 0; i < 5; ++i) clock.RunNext();
  // Five turns, five pictures, though two dozen repeats are owed by now for each.
  EXPECT_EQ(drawn.size(), 5u);
}

TEST_F(FilmTest, AFilmStoppedAtOnceHasOneFrame) {
  ASSERT_TRUE(film.Start("a.mp4", 30));
  EXPECT_EQ(film.Stop("")->frames, 1);
  EXPECT_EQ(film.Stop("").error().code, vm::Errc::kBadValue);
}

TEST_F(FilmTest, FramesArriveInOrderAndRepeatedOnesAfterThatWhichTheyRepeat) {
  std::vector<float> expected;
  FaceState state;
  FilmRecorder moving(
      clock, world, world.files,
      [&](long number, vm::Time) {
        expected.resize(static_cast<std::size_t>(number), expected.empty() ? 0 : expected.back());
        state.mouth[kJawY] = static_cast<float>(number % 20);
        expected.push_back(state.mouth[kJawY]);
        clock.now += number % 7 == 3 ? 150ms : 10ms;
        return world.Draw(state, Scene{}, nullptr);
      },
      [](const vm::Error&) {});
  ASSERT_TRUE(moving.Start("a.mp4", 30));
  while (clock.now < 2s) clock.RunNext();
  const auto report = moving.Stop("");
  ASSERT_TRUE(report);
  EXPECT_GT(report->repeated, 5);
  EXPECT_EQ(world.films["a.mp4"].jaws, expected);
  EXPECT_TRUE(std::ranges::all_of(world.readings, [](auto& image) { return image.rgba.empty(); }));
}

TEST_F(FilmTest, AFilmThatFailsLeavesNoFrameBehind) {
  ASSERT_TRUE(film.Start("a.mp4", 30));
  clock.RunNext();
  world.no_drawing = "lost";
  clock.RunNext();
  EXPECT_FALSE(film.recording());
  EXPECT_TRUE(world.readings.at(0).rgba.empty());
}

TEST_F(FilmTest, AViewOfAnotherSizeEndsTheFilm) {
  ASSERT_TRUE(film.Start("a.mp4", 30));
  clock.RunNext();
  ASSERT_TRUE(world.Resize(641, 480));
  clock.RunNext();
  EXPECT_FALSE(film.recording());
  EXPECT_NE(failure.find("640 x 480 has ended, for the view is 641 x 480"), std::string::npos)
      << failure;
  EXPECT_LE(world.films["a.mp4"].jaws.size(), 1U) << "nothing of another size was written";
}

/// Writes pictures of 1000 bytes.
const MediaFiles kPictureFiles{
    .write_image = [](const Image&, const std::string& path) -> vm::Result<void> {
      std::ofstream(path) << std::string(1000, 'x');
      return {};
    }};

struct CaptureTest : testing::Test {
  CaptureTest() {
    folder = std::filesystem::path(testing::TempDir()) / "capture_test";
    std::filesystem::remove_all(folder);
    std::filesystem::create_directory(folder);
  }
  ~CaptureTest() override { std::filesystem::remove_all(folder); }

  Capture Make(CaptureLimits limits = {}) {
    return Capture(
        clock, world, kPictureFiles,
        [this](long, vm::Time at) {
          drawn.push_back(at);
          clock.now += drawing_takes;
          return world.Draw(FaceState{}, Scene{}, nullptr);
        },
        [this](const vm::Result<void>& done) {
          ends.push_back(done ? "" : vm::FormatError(done.error()));
        },
        limits);
  }
  long Files() const {
    return std::distance(std::filesystem::directory_iterator(folder),
                         std::filesystem::directory_iterator());
  }

  LateClock clock;
  FakeWorld world;
  std::filesystem::path folder;
  std::vector<vm::Time> drawn;
  std::vector<std::string> ends;
  vm::Time drawing_takes{0};
};

TEST_F(CaptureTest, ALateMachineMakesThePicturesOfTheUtteranceAndNoMore) {
  // Drawing takes longer than the time between two pictures: whoever waits for the clock to pass
  // the last of them, or draws on to the time it is by now, makes too many or never ends.
  drawing_takes = 700ms;
  Capture capture = Make();
  capture.Arm({folder.string(), "a", 10});
  capture.Begin(clock.now);
  clock.RunNext();
  clock.now += 5s;
  capture.End(1200ms);
  const std::size_t before = drawn.size();
  clock.RunNext();
  EXPECT_EQ(drawn.size(), before + 1) << "one a turn, so that others have theirs";
  while (capture.running()) clock.RunNext();
  EXPECT_EQ(drawn.size(), 13u);
  EXPECT_EQ(drawn.back(), vm::Time(1200ms));
  EXPECT_EQ(Files(), 13);
  EXPECT_EQ(ends, std::vector<std::string>{""});
}

TEST_F(CaptureTest, TheLastPictureIsNotLostToALateBegin) {
  Capture capture = Make();
  capture.Arm({folder.string(), "a", 10});
  clock.now = 3ms;
  capture.Begin(0ms);
  capture.End(200ms);
  while (capture.running()) clock.RunNext();
  EXPECT_EQ(drawn, (std::vector<vm::Time>{0ms, 100ms, 200ms}));
}

TEST_F(CaptureTest, TheNumberOfPicturesIsBounded) {
  Capture capture = Make({.pictures = 5});
  capture.Arm({folder.string(), "a", 10});
  capture.Begin(clock.now);
  while (capture.running()) clock.RunNext();
  EXPECT_EQ(Files(), 5);
  EXPECT_EQ(ends, std::vector<std::string>{"LIMIT Capture: more than 5 pictures"});
}

TEST_F(CaptureTest, WhatTheyTakeOnTheDiskIsBounded) {
  Capture capture = Make({.bytes = 3500});
  capture.Arm({folder.string(), "a", 10});
  capture.Begin(clock.now);
  while (capture.running()) clock.RunNext();
  EXPECT_EQ(Files(), 4);
  ASSERT_EQ(ends.size(), 1u);
  EXPECT_TRUE(ends[0].starts_with("LIMIT Capture: the pictures in '" + folder.string())) << ends[0];
}

TEST_F(CaptureTest, CancelStopsItWithoutAWord) {
  Capture capture = Make();
  capture.Arm({folder.string(), "a", 10});
  capture.Begin(clock.now);
  clock.RunNext();
  capture.Cancel();
  EXPECT_FALSE(capture.running());
  EXPECT_EQ(Files(), 2);
  EXPECT_TRUE(ends.empty());
}

}  // namespace
}  // namespace fsm
