#include "ssm/sinks/portaudio_sink.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "ssm/sinks/sink_choice.h"
#include "tests/ssm/fake_portaudio.h"
#include "vm_protocol/core/scheduler.h"

namespace ssm {
namespace {

class PortAudioSinkTest : public testing::Test {
 protected:
  vm::VirtualScheduler clock_;
  std::shared_ptr<SampleBuffer> ramp_ = [] {
    std::vector<std::int16_t> samples(16000);
    for (std::size_t i = 0; i < samples.size(); ++i) samples[i] = static_cast<std::int16_t>(i + 1);
    auto buffer = std::make_shared<SampleBuffer>(samples.size());
    buffer->Append(samples);
    return buffer;
  }();

  std::unique_ptr<AudioSink> Open() {
    fake_portaudio::SetDevices({{"Microphone", 0}, {"HDA Speaker", 2}, {"USB Headset", 2}}, 1);
    auto sink = OpenPortAudio(clock_, "", [this] { return clock_.Now(); });
    EXPECT_TRUE(sink);
    return std::move(*sink);
  }
};

TEST_F(PortAudioSinkTest, TheDeviceIsFoundByNameOrByDefault) {
  fake_portaudio::SetDevices({{"Microphone", 0}, {"HDA Speaker", 2}, {"USB Headset", 2}}, 1);
  EXPECT_TRUE(HasSoundDevice());
  EXPECT_EQ((*OpenPortAudio(clock_, ""))->name(), "portaudio:HDA Speaker");
  EXPECT_EQ((*OpenPortAudio(clock_, "headset"))->name(), "portaudio:USB Headset");
  EXPECT_FALSE(fake_portaudio::StreamIsOpen()) << "closed with its sink";
  const auto none = OpenPortAudio(clock_, "micro");
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().text,
            "no sound device 'micro', expected one of: HDA Speaker, USB Headset");
}

TEST_F(PortAudioSinkTest, NoDeviceAndBadDevicesAreRefused) {
  fake_portaudio::SetDevices({}, -1);
  EXPECT_FALSE(HasSoundDevice());
  EXPECT_EQ(OpenPortAudio(clock_, "").error().text, "there is no sound device");
  fake_portaudio::SetDevices({{"null", 2}}, 0);
  EXPECT_FALSE(HasSoundDevice());
  EXPECT_EQ(OpenPortAudio(clock_, "").error().code, vm::Errc::kUnavailable);
  fake_portaudio::SetDevices({{"x", 2}}, 0);
  fake_portaudio::RefuseToOpen(true);
  EXPECT_NE(OpenPortAudio(clock_, "").error().text.find("cannot be opened"), std::string::npos);
  const OpenedSink opened = OpenSink({SinkChoice::Kind::kAuto, {}}, clock_);
  EXPECT_EQ(opened.sink->name(), "null");
  EXPECT_NE(opened.notice.find("speaking silently"), std::string::npos);
}

TEST_F(PortAudioSinkTest, ADeviceThatSwallowsSoundIsFoundOut) {
  fake_portaudio::SetDevices({{"default", 2}}, 0);
  fake_portaudio::SwallowAtStart(10 * 16000);
  const auto sink = OpenPortAudio(clock_, "");
  ASSERT_FALSE(sink);
  EXPECT_NE(sink.error().text.find("at any speed"), std::string::npos);
}

TEST_F(PortAudioSinkTest, SilenceUntilSomethingPlays) {
  const auto sink = Open();
  const auto buffer = fake_portaudio::Take(256, 0.02);
  EXPECT_TRUE(std::all_of(buffer.begin(), buffer.end(), [](auto s) { return s == 0; }));
}

TEST_F(PortAudioSinkTest, TheFirstFrameIsHeardAtTheInstantAskedFor) {
  const auto sink = Open();
  clock_.RunUntil(vm::Time(1'000'000));
  const vm::Time start = clock_.Now() + vm::Time(400'000);
  ASSERT_TRUE(sink->Play(ramp_, start));
  clock_.RunUntil(vm::Time(1'100'000));
  const auto buffer = fake_portaudio::Take(16 * 40, 0.28);  // 20 ms of silence, then speech
  const auto first = std::find_if(buffer.begin(), buffer.end(), [](auto s) { return s != 0; });
  ASSERT_EQ(first - buffer.begin(), 16 * 20);
  EXPECT_EQ(*first, 1);
  EXPECT_EQ(sink->Where().first_frame, start);
  EXPECT_EQ(sink->Where().frames, 0u) << "handed over, but not heard yet";
  const auto next = fake_portaudio::Take(160, 0.32);
  EXPECT_EQ(next[0], 16 * 20 + 1) << "no frame is lost";
  clock_.RunUntil(start + vm::Time(10'000));
  EXPECT_EQ(sink->Where().frames, 160u) << "10 ms are heard";
  sink->Stop();
}

TEST_F(PortAudioSinkTest, AStartThatIsLateBeginsAtOnceWithTheFirstFrame) {
  const auto sink = Open();
  clock_.RunUntil(vm::Time(50'000));
  ASSERT_TRUE(sink->Play(ramp_, vm::Time(0)));
  const auto buffer = fake_portaudio::Take(160, 0.025);
  EXPECT_EQ(buffer[0], 1);
  EXPECT_EQ(sink->Where().first_frame, clock_.Now() + vm::Time(25'000));
  sink->Stop();
}

TEST_F(PortAudioSinkTest, StopFadesOutAndTellsWhatWasHandedOver) {
  const auto sink = Open();
  ASSERT_TRUE(sink->Play(ramp_, vm::Time(0)));
  fake_portaudio::Take(800, 0.01);
  EXPECT_EQ(sink->Stop().frames, 800u);
  const auto after = fake_portaudio::Take(160, 0.01);
  EXPECT_GT(after[0], after[40]);
  EXPECT_EQ(after[80], 0);
  EXPECT_EQ(after[159], 0);
  const auto later = fake_portaudio::Take(160, 0.01);
  EXPECT_TRUE(std::all_of(later.begin(), later.end(), [](auto s) { return s == 0; }));
  ASSERT_TRUE(sink->Play(ramp_, vm::Time(0))) << "the next utterance plays from its beginning";
  EXPECT_EQ(fake_portaudio::Take(16, 0)[0], 1);
  sink->Stop();
}

TEST_F(PortAudioSinkTest, SoundThatIsMadeTooLateComesLaterButWhole) {
  const auto sink = Open();
  auto slow = std::make_shared<SampleBuffer>(320);
  const std::vector<std::int16_t> half(160, 5);
  slow->Append(half);
  ASSERT_TRUE(sink->Play(slow, vm::Time(0)));
  auto buffer = fake_portaudio::Take(240, 0);
  EXPECT_EQ(buffer[159], 5);
  EXPECT_EQ(buffer[160], 0);
  slow->Append(half);
  buffer = fake_portaudio::Take(240, 0);
  EXPECT_EQ(buffer[0], 5);
  EXPECT_EQ(buffer[159], 5);
  EXPECT_EQ(buffer[160], 0);
  sink->Stop();
}

}  // namespace
}  // namespace ssm
