#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <filesystem>
#include <stdexcept>

#include "ssm/sinks/file_sink.h"
#include "ssm/sinks/portaudio_sink.h"
#include "ssm/sinks/sink_choice.h"
#include "ssm/voice/tape.h"
#include "tests/support/process.h"

namespace ssm {
namespace {

std::shared_ptr<SampleBuffer> Ramp(std::size_t frames) {
  std::vector<std::int16_t> samples(frames);
  for (std::size_t i = 0; i < frames; ++i) samples[i] = static_cast<std::int16_t>(i + 1);
  auto buffer = std::make_shared<SampleBuffer>(frames);
  buffer->Append(samples);
  return buffer;
}

TEST(ClockSinkTest, FramesPassWithTheClock) {
  vm::VirtualScheduler clock;
  ClockSink sink(clock);
  ASSERT_TRUE(sink.Play(Ramp(1600), vm::Time(10'000)));
  EXPECT_EQ(sink.Where().frames, 0u);
  clock.RunUntil(vm::Time(10'000));
  EXPECT_EQ(sink.Where().frames, 0u);
  EXPECT_EQ(sink.Where().first_frame, vm::Time(10'000));
  clock.RunUntil(vm::Time(10'063));  // one frame is 62.5 us
  EXPECT_EQ(sink.Where().frames, 1u);
  clock.RunUntil(vm::Time(60'000));
  EXPECT_EQ(sink.Where().frames, 800u);
  clock.RunUntil(vm::Time(500'000));
  EXPECT_EQ(sink.Where().frames, 1600u);
  EXPECT_EQ(sink.Stop().frames, 1600u);
}

TEST(ClockSinkTest, APastStartIsNow) {
  vm::VirtualScheduler clock;
  clock.RunUntil(vm::Time(5000));
  ClockSink sink(clock);
  ASSERT_TRUE(sink.Play(Ramp(160), vm::Time(0)));
  EXPECT_EQ(sink.Where().first_frame, vm::Time(5000));
  sink.Stop();
}

TEST(FileSinkTest, HoldsWhatWasHeardOneAfterTheOther) {
  const support::TempDir dir;
  vm::VirtualScheduler clock;
  const auto sound = Ramp(320);
  {
    FileSink sink(clock, dir / "out.wav");
    ASSERT_TRUE(sink.Play(sound, vm::Time(0)));
    clock.RunUntil(vm::Time(20'000));
    sink.Stop();
    clock.RunUntil(vm::Time(900'000));
    ASSERT_TRUE(sink.Play(sound, clock.Now()));
    clock.RunUntil(vm::Time(910'000));
    EXPECT_EQ(sink.Stop().frames, 160u);
    const auto meanwhile = ReadWav(dir / "out.wav");
    ASSERT_TRUE(meanwhile) << "the file must be whole while the sink lives";
    EXPECT_EQ(meanwhile->size(), 480u);
  }
  const auto written = *ReadWav(dir / "out.wav");
  ASSERT_EQ(written.size(), 480u);
  EXPECT_EQ(written[319], 320);
  EXPECT_EQ(written[320], 1);
  EXPECT_EQ(written[479], 160);
}

TEST(FileSinkTest, AFileThatCannotBeWrittenIsASentence) {
  vm::VirtualScheduler clock;
  try {
    FileSink sink(clock, "/nowhere/out.wav");
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("/nowhere/out.wav"), std::string::npos);
  }
}

TEST(TapeTest, SpeechStandsWhereItWasPlayed) {
  const support::TempDir dir;
  auto tape = Tape::Start(dir / "t.wav", vm::Time(1'000'000));
  ASSERT_TRUE(tape);
  const auto sound = Ramp(160);
  ASSERT_TRUE((*tape)->Add(vm::Time(995'000), sound->Ready()));  // begun 5 ms before the tape
  ASSERT_TRUE((*tape)->Add(vm::Time(1'020'000), sound->Ready()));
  ASSERT_TRUE((*tape)->Add(vm::Time(1'025'000), sound->Ready()));  // overlaps by 5 ms
  ASSERT_TRUE((*tape)->Close(vm::Time(1'100'000)));
  const auto samples = *ReadWav(dir / "t.wav");
  ASSERT_EQ(samples.size(), 1600u);
  EXPECT_EQ(samples[0], 81);
  EXPECT_EQ(samples[79], 160);
  EXPECT_EQ(samples[80], 0);
  EXPECT_EQ(samples[319], 0);
  EXPECT_EQ(samples[320], 1);
  EXPECT_EQ(samples[479], 160);
  EXPECT_EQ(samples[480], 81);
  EXPECT_EQ(samples[559], 160);
  EXPECT_EQ(samples[560], 0);
}

TEST(WavFileTest, OtherFormatsAreRefusedWithAReason) {
  const support::TempDir dir;
  EXPECT_EQ(ReadWav(dir / "none.wav").error().code, vm::Errc::kUnavailable);
  ASSERT_TRUE(WriteRaw(dir / "junk.wav", std::vector<std::int16_t>(100, 7)));
  EXPECT_EQ(ReadWav(dir / "junk.wav").error().code, vm::Errc::kUnavailable);
}

/// No file grows beyond `bytes`, as on a full disk, while this lives.
class FullDisk {
 public:
  explicit FullDisk(rlim_t bytes) {
    ::getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit less{.rlim_cur = bytes, .rlim_max = before_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &less);
  }
  ~FullDisk() {
    ::setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }
  FullDisk(const FullDisk&) = delete;

 private:
  rlimit before_{};
  void (*const handler_)(int) = std::signal(SIGXFSZ, SIG_IGN);
};

TEST(WavFileTest, WhatDoesNotFitOnTheDiskIsRemovedAndThatIsSaid) {
  const support::TempDir dir;
  const std::vector<std::int16_t> second(kSampleRateHz, 7);
  vm::Result<void> wav, raw;
  {
    const FullDisk full(20'000);
    wav = WriteWav(dir / "x.wav", second);
    raw = WriteRaw(dir / "x.raw", second);
  }
  for (const auto& [written, path] : {std::pair(wav, dir / "x.wav"), {raw, dir / "x.raw"}}) {
    ASSERT_FALSE(written);
    EXPECT_EQ(written.error().code, vm::Errc::kUnavailable);
    EXPECT_TRUE(written.error().text.contains("File too large")) << written.error().text;
    EXPECT_TRUE(written.error().text.ends_with("; the part that was written is removed"))
        << written.error().text;
    EXPECT_FALSE(std::filesystem::exists(path)) << path;
  }
}

TEST(TapeTest, OnAFullDiskItKeepsWhatFittedAndSaysHowMuch) {
  const support::TempDir dir;
  auto tape = Tape::Start(dir / "tape.wav", vm::Time(0));
  ASSERT_TRUE(tape);
  vm::Result<void> added;
  {
    const FullDisk full(20'000);
    added = (*tape)->Add(vm::Time(0), std::vector<std::int16_t>(kSampleRateHz, 7));
    tape->reset();
  }
  ASSERT_FALSE(added);
  EXPECT_TRUE(added.error().text.ends_with("; the recording ends after 623 ms"))
      << added.error().text;
  EXPECT_EQ(ReadWav(dir / "tape.wav")->size(), 9978u) << "44 bytes are the header";
}

TEST(SinkChoiceTest, FormsAreReadAndOthersRefused) {
  using Kind = SinkChoice::Kind;
  EXPECT_EQ(ParseSinkChoice("auto")->kind, Kind::kAuto);
  EXPECT_EQ(ParseSinkChoice("null")->kind, Kind::kNull);
  EXPECT_EQ(ParseSinkChoice("portaudio")->kind, Kind::kPortAudio);
  EXPECT_EQ(ParseSinkChoice("portaudio:USB: x")->argument, "USB: x");
  EXPECT_EQ(ParseSinkChoice("file:a b.wav")->argument, "a b.wav");
  for (const char* bad : {"", "file:", "file", "alsa", "null:x", "AUTO"}) {
    EXPECT_FALSE(ParseSinkChoice(bad)) << bad;
  }
}

TEST(PortAudioTest, AnUnknownDeviceIsRefusedWithASentence) {
  vm::VirtualScheduler clock;
  const auto sink = OpenPortAudio(clock, "no such device anywhere");
  ASSERT_FALSE(sink);
  EXPECT_EQ(sink.error().code, vm::Errc::kUnavailable);
  EXPECT_NE(sink.error().text.find("sound device"), std::string::npos) << sink.error().text;
}

}  // namespace
}  // namespace ssm
