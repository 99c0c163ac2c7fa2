#include <gtest/gtest.h>

#include <functional>
#include <utility>
#include <vector>

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
            clock, studio,
            [this](long number, vm::Time at) {
              drawn.emplace_back(number, at);
              clock.now += drawing_takes;
              return studio.Draw(FaceState{}, Scene{});
            },
            [](const vm::Error&) {}) {}

  LateClock clock;
  FakeRenderBackend studio;
  std::vector<std::pair<long, vm::Time>> drawn;
  vm::Time drawing_takes{0};
  Film film;
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
  EXPECT_EQ(studio.films["a.mp4"].jaws.size(), static_cast<std::size_t>(report->frames));
  EXPECT_EQ(studio.films["a.mp4"].sound, "voice.wav");
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

}  // namespace
}  // namespace fsm
