#include <gtest/gtest.h>

#include <boost/asio/executor_work_guard.hpp>

#include "ssm/app/original_config.h"
#include "ssm/app/real_time_sink.h"
#include "ssm/app/thread_worker.h"

namespace ssm {
namespace {

TEST(OriginalConfigTest, MeaningfulKeysAreReadAndOthersNoticed) {
  const auto config = ParseOriginalConfig(
      "# comment\n\nCHASEN: ./chasen\r\nAUTO-PLAY: YES\n AUTO-PLAY-DELAY :250\n"
      "SPEAKER-ID: male01\nGENDER: male\nMCEP-MODEL-FILE: a\nMCEP-MODEL-FILE: b\n"
      "SPEAKER-ID: female01\nGENDER: female");
  ASSERT_TRUE(config) << config.error().text;
  EXPECT_TRUE(config->auto_play);
  EXPECT_EQ(config->auto_play_delay.count(), 250);
  ASSERT_EQ(config->speakers.size(), 2u);
  EXPECT_FALSE(config->speakers[0].female);
  EXPECT_TRUE(config->speakers[1].female);
  EXPECT_EQ(config->notice, "without meaning for this engine: CHASEN, MCEP-MODEL-FILE");
}

TEST(OriginalConfigTest, FaultsNameTheirLine) {
  const struct {
    const char* text;
    vm::Errc code;
  } cases[] = {{"\nSPEAKER-ID male01", vm::Errc::kSyntax},
               {"\nSPEAKER-ID:", vm::Errc::kBadValue},
               {"\nSPEAKER-ID: a b", vm::Errc::kBadValue},
               {"\nGENDER: male", vm::Errc::kBadValue},
               {"SPEAKER-ID: a\nGENDER: it", vm::Errc::kBadValue},
               {"\nAUTO-PLAY: yes", vm::Errc::kBadValue},
               {"\nAUTO-PLAY-DELAY: -1", vm::Errc::kBadValue},
               {"\nAUTO-PLAY-DELAY: 1x", vm::Errc::kBadValue},
               {"\nVOLUME: 3", vm::Errc::kUnknownSlot}};
  for (const auto& one : cases) {
    const auto config = ParseOriginalConfig(one.text);
    ASSERT_FALSE(config) << one.text;
    EXPECT_EQ(config.error().code, one.code) << one.text;
    EXPECT_TRUE(config.error().text.starts_with("line 2: ")) << config.error().text;
  }
}

TEST(ThreadWorkerTest, JobsRunInOrderElsewhereAndEndHere) {
  boost::asio::io_context io;
  const vm::ClockScheduler clock(io, true);
  const auto here = std::this_thread::get_id();
  std::string order;
  bool elsewhere = true, back = true;
  ThreadWorker worker(io, clock);
  EXPECT_FALSE(worker.immediate());
  const auto guard = boost::asio::make_work_guard(io);
  for (const char name : {'a', 'b', 'c'}) {
    worker.Run(
        [&, name] {
          order += name;
          elsewhere = elsewhere && std::this_thread::get_id() != here;
        },
        [&, name] {
          back = back && std::this_thread::get_id() == here;
          if (name == 'c') io.stop();
        });
  }
  io.run();
  EXPECT_EQ(order, "abc");
  EXPECT_TRUE(elsewhere && back);
}

TEST(ThreadWorkerTest, OnAVirtualClockWorkIsDoneOnTheSpot) {
  boost::asio::io_context io;
  const vm::ClockScheduler clock(io, false);
  ThreadWorker worker(io, clock);
  int step = 0;
  worker.Run([&] { step = 1; }, [&] { step = step == 1 ? 2 : -1; });
  EXPECT_EQ(step, 2);
}

TEST(ThreadWorkerTest, TheEndWaitsForTheJobInHandOnly) {
  boost::asio::io_context io;
  const vm::ClockScheduler clock(io, true);
  bool done = false;
  {
    ThreadWorker worker(io, clock);
    for (int i = 0; i < 100; ++i) worker.Run([] {}, [&] { done = true; });
  }
  EXPECT_FALSE(done) << "nothing runs on this thread without its loop";
}

TEST(RealTimeSinkTest, TheDeviceIsUsedWhileTheClockIsReal) {
  class Device final : public AudioSink {
   public:
    explicit Device(int& plays) : plays_(plays) {}
    vm::Result<void> Play(std::shared_ptr<const SampleBuffer>, vm::Time) override {
      ++plays_;
      return {};
    }
    Position Where() const override { return {}; }
    Position Stop() override { return {}; }
    std::string name() const override { return "device"; }

   private:
    int& plays_;
  };
  boost::asio::io_context io;
  vm::ClockScheduler clock(io, true);
  int plays = 0;
  RealTimeSink sink(clock, std::make_unique<Device>(plays));
  const auto sound = std::make_shared<SampleBuffer>(1600);
  ASSERT_TRUE(sink.Play(sound, clock.Now()));
  clock.UseVirtual();
  sink.Stop();
  EXPECT_EQ(plays, 1);
  ASSERT_TRUE(sink.Play(sound, clock.Now()));
  clock.Advance(clock.Now() + vm::Time(50'000));
  EXPECT_EQ(sink.Stop().frames, 800u);
  EXPECT_EQ(plays, 1);
  EXPECT_EQ(sink.name(), "device");
}

}  // namespace
}  // namespace ssm
