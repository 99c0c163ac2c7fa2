#include <fcntl.h>
#include <portaudio.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cstdio>
#include <utility>

#include "sound/sources.h"
#include "vm_protocol/core/lower_case.h"

namespace sound {
namespace {

constexpr vm::Time kPoll{20'000};
constexpr std::size_t kRing = std::size_t{1} << 16;  // 4 s
constexpr double kRateHz = 16000;
constexpr int kDeadPolls = 150;  // 3 s without sound: the device is gone

/// PortAudio's back ends write dozens of lines to stderr while they look for devices.
class QuietStderr {
 public:
  QuietStderr() : saved_(dup(STDERR_FILENO)) {
    const int null = open("/dev/null", O_WRONLY | O_CLOEXEC);
    if (null >= 0) {
      dup2(null, STDERR_FILENO);
      close(null);
    }
  }
  ~QuietStderr() {
    if (saved_ < 0) return;
    dup2(saved_, STDERR_FILENO);
    close(saved_);
  }
  QuietStderr(const QuietStderr&) = delete;

 private:
  const int saved_;
};

/// A microphone. The library's thread writes to a ring; the scheduler's thread takes from it.
class Microphone final : public AudioSource {
 public:
  explicit Microphone(vm::Scheduler& scheduler) : scheduler_(scheduler) {}
  ~Microphone() override {
    if (timer_ != 0) scheduler_.Cancel(timer_);
    const QuietStderr quiet;
    if (stream_ != nullptr) {
      Pa_AbortStream(stream_);
      Pa_CloseStream(stream_);
    }
    if (started_) Pa_Terminate();
  }

  vm::Result<void> Open(const std::string& wanted) {
    const QuietStderr quiet;
    if (Pa_Initialize() != paNoError) return Unavailable("the sound system cannot be used");
    started_ = true;
    PaDeviceIndex chosen = wanted.empty() ? Pa_GetDefaultInputDevice() : paNoDevice;
    for (PaDeviceIndex i = 0; i < Pa_GetDeviceCount() && chosen == paNoDevice; ++i) {
      const PaDeviceInfo* info = Pa_GetDeviceInfo(i);
      const bool fits = vm::LowerCase(info->name).find(vm::LowerCase(wanted)) != std::string::npos;
      if (info->maxInputChannels > 0 && fits) chosen = i;
    }
    if (chosen == paNoDevice) {
      return Unavailable(wanted.empty() ? "there is no microphone"
                                        : "no microphone '" + wanted + "'");
    }
    PaStreamParameters input{};
    input.device = chosen;
    input.channelCount = 1;
    input.sampleFormat = paInt16;
    input.suggestedLatency = Pa_GetDeviceInfo(chosen)->defaultLowInputLatency;
    const PaError error =
        Pa_OpenStream(&stream_, &input, nullptr, kRateHz, 320, paNoFlag, OnSound, this);
    if (error == paNoError) return {};
    stream_ = nullptr;
    return Unavailable("microphone '" + std::string(Pa_GetDeviceInfo(chosen)->name) +
                       "' cannot be opened: " + Pa_GetErrorText(error));
  }

  vm::Result<void> Start(Events events) override {
    events_ = std::move(events);
    if (Pa_StartStream(stream_) != paNoError)
      return Unavailable("the microphone cannot be started");
    timer_ = scheduler_.After(kPoll, [this] { Take(); });
    return {};
  }
  bool Ends() const override { return false; }

 private:
  static std::unexpected<vm::Error> Unavailable(std::string text) {
    return vm::Fail(vm::Errc::kUnavailable, std::move(text));
  }

  static int OnSound(const void* input, void*, unsigned long frames,
                     const PaStreamCallbackTimeInfo*, PaStreamCallbackFlags, void* self) {
    auto& mine = *static_cast<Microphone*>(self);
    const auto* samples = static_cast<const std::int16_t*>(input);
    std::size_t at = mine.written_.load(std::memory_order_relaxed);
    for (unsigned long i = 0; samples != nullptr && i < frames; ++i)
      mine.ring_[at++ % kRing] = samples[i];
    mine.written_.store(at, std::memory_order_release);
    return paContinue;
  }

  void Take() {
    timer_ = scheduler_.After(kPoll, [this] { Take(); });
    const std::size_t written = written_.load(std::memory_order_acquire);
    if (written - taken_ > kRing / 2) taken_ = written - kRing / 2;  // we were away too long
    std::vector<std::int16_t> samples;
    for (; taken_ < written; ++taken_) samples.push_back(ring_[taken_ % kRing]);
    silent_polls_ = samples.empty() ? silent_polls_ + 1 : 0;
    if (silent_polls_ > kDeadPolls) {
      scheduler_.Cancel(std::exchange(timer_, 0));
      return events_.failed({vm::Errc::kUnavailable, "the microphone gives no sound any more", 0});
    }
    if (!samples.empty()) events_.sound(samples);
  }

  vm::Scheduler& scheduler_;
  PaStream* stream_ = nullptr;
  bool started_ = false;
  Events events_;
  vm::TimerId timer_ = 0;
  std::size_t taken_ = 0;
  int silent_polls_ = 0;
  std::array<std::int16_t, kRing> ring_{};
  std::atomic<std::size_t> written_{0};
};

}  // namespace

vm::Result<std::unique_ptr<AudioSource>> OpenMicrophone(const std::string& device,
                                                        vm::Scheduler& scheduler) {
  auto microphone = std::make_unique<Microphone>(scheduler);
  if (auto opened = microphone->Open(device); !opened) return std::unexpected(opened.error());
  return microphone;
}

}  // namespace sound
