#include "srm/engine/echo_canceller.h"

#include <speex/speex_echo.h>
#include <speex/speex_preprocess.h>

#include <algorithm>

namespace srm {
namespace {

constexpr std::size_t kEchoFrame = 16 * kFramesPerMs;
constexpr std::size_t kMostAhead = 2000 * kFramesPerMs;
constexpr auto kTailSamples = static_cast<int>(EchoCanceller::kTail.count()) * 16;

}  // namespace

struct EchoCanceller::State {
  SpeexEchoState* echo = speex_echo_state_init(static_cast<int>(kEchoFrame), kTailSamples);
  SpeexPreprocessState* rest =
      speex_preprocess_state_init(static_cast<int>(kEchoFrame), static_cast<int>(kSampleRateHz));
  State() {
    int rate = static_cast<int>(kSampleRateHz);
    int off = 0;
    speex_echo_ctl(echo, SPEEX_ECHO_SET_SAMPLING_RATE, &rate);
    speex_preprocess_ctl(rest, SPEEX_PREPROCESS_SET_ECHO_STATE, echo);
    // The recogniser's features are made for the noise as it is.
    speex_preprocess_ctl(rest, SPEEX_PREPROCESS_SET_DENOISE, &off);
  }
  ~State() {
    speex_preprocess_state_destroy(rest);
    speex_echo_state_destroy(echo);
  }
};

EchoCanceller::EchoCanceller() : state_(std::make_unique<State>()) {}
EchoCanceller::~EchoCanceller() = default;

void EchoCanceller::Play(std::span<const std::int16_t> voice) {
  voice_.insert(voice_.end(), voice.begin(), voice.end());
  while (voice_.size() > kMostAhead) voice_.pop_front();
}

std::vector<std::int16_t> EchoCanceller::Clean(std::span<const std::int16_t> heard) {
  heard_.insert(heard_.end(), heard.begin(), heard.end());
  std::vector<std::int16_t> clean;
  std::vector<std::int16_t> near(kEchoFrame), far(kEchoFrame), out(kEchoFrame);
  const auto take = [](std::deque<std::int16_t>& from, std::vector<std::int16_t>& to) {
    const std::size_t count = std::min(from.size(), kEchoFrame);
    std::fill(to.begin(), to.end(), std::int16_t{0});
    std::copy_n(from.begin(), count, to.begin());
    from.erase(from.begin(), from.begin() + static_cast<std::ptrdiff_t>(count));
  };
  while (heard_.size() >= kEchoFrame) {
    take(heard_, near);
    take(voice_, far);
    speex_echo_cancellation(state_->echo, near.data(), far.data(), out.data());
    speex_preprocess_run(state_->rest, out.data());
    clean.insert(clean.end(), out.begin(), out.end());
  }
  return clean;
}

}  // namespace srm
