#include "sound/sound_file.h"

#include <sndfile.h>
#include <speex/speex_resampler.h>

#include <memory>

namespace sound {
namespace {

constexpr unsigned kRateHz = 16000;
constexpr std::size_t kMaxSeconds = 7200;

std::vector<std::int16_t> Resampled(const std::vector<std::int16_t>& samples, unsigned rate) {
  if (rate == kRateHz) return samples;
  int error = 0;
  std::unique_ptr<SpeexResamplerState, void (*)(SpeexResamplerState*)> state(
      speex_resampler_init(1, rate, kRateHz, 8, &error), speex_resampler_destroy);
  if (!state) return {};
  speex_resampler_skip_zeros(state.get());
  std::vector<std::int16_t> result(samples.size() * kRateHz / rate + 1);
  std::size_t taken = 0, made = 0;
  while (taken < samples.size() && made < result.size()) {
    auto in = static_cast<spx_uint32_t>(std::min<std::size_t>(samples.size() - taken, 1u << 20));
    auto out = static_cast<spx_uint32_t>(std::min<std::size_t>(result.size() - made, 1u << 20));
    speex_resampler_process_int(state.get(), 0, samples.data() + taken, &in, result.data() + made,
                                &out);
    if (in == 0 && out == 0) break;
    taken += in;
    made += out;
  }
  result.resize(made);
  return result;
}

}  // namespace

struct StreamResampler::State {
  SpeexResamplerState* speex = nullptr;
  ~State() { speex_resampler_destroy(speex); }
};

StreamResampler::StreamResampler(unsigned rate_hz) : rate_hz_(rate_hz) {
  if (rate_hz == kRateHz) return;
  int error = 0;
  state_ = std::make_unique<State>();
  state_->speex = speex_resampler_init(1, rate_hz, kRateHz, 5, &error);
  speex_resampler_skip_zeros(state_->speex);
}
StreamResampler::~StreamResampler() = default;

std::vector<std::int16_t> StreamResampler::Add(const std::vector<std::int16_t>& samples) {
  if (!state_) return samples;
  std::vector<std::int16_t> result(samples.size() * kRateHz / rate_hz_ + 64);
  auto in = static_cast<spx_uint32_t>(samples.size());
  auto out = static_cast<spx_uint32_t>(result.size());
  speex_resampler_process_int(state_->speex, 0, samples.data(), &in, result.data(), &out);
  result.resize(out);
  return result;
}

vm::Result<std::vector<std::int16_t>> ReadSound(const std::string& path) {
  SF_INFO info{};
  if (path.ends_with(".raw")) {
    info.samplerate = kRateHz;
    info.channels = 1;
    info.format = SF_FORMAT_RAW | SF_FORMAT_PCM_16 | SF_ENDIAN_LITTLE;
  }
  std::unique_ptr<SNDFILE, int (*)(SNDFILE*)> file(sf_open(path.c_str(), SFM_READ, &info),
                                                   sf_close);
  if (!file) {
    return vm::Fail(vm::Errc::kUnavailable, "cannot read '" + path + "': " + sf_strerror(nullptr));
  }
  if (info.samplerate < 1000 || info.samplerate > 400'000 || info.channels > 64) {
    return vm::Fail(vm::Errc::kBadValue, "'" + path + "' has " + std::to_string(info.channels) +
                                             " channels at " + std::to_string(info.samplerate) +
                                             " Hz, expected 1 to 64 at 1000 to 400000 Hz");
  }
  // The header's length is not believed; what can be read counts.
  const auto channels = static_cast<std::size_t>(info.channels);
  const auto rate = static_cast<unsigned>(info.samplerate);
  std::vector<short> block(4096 * channels);
  std::vector<std::int16_t> mono;
  for (sf_count_t got; (got = sf_readf_short(file.get(), block.data(), 4096)) > 0;) {
    for (std::size_t i = 0; i < static_cast<std::size_t>(got); ++i) {
      int sum = 0;
      for (std::size_t c = 0; c < channels; ++c) sum += block[i * channels + c];
      mono.push_back(static_cast<std::int16_t>(sum / info.channels));
    }
    if (mono.size() > kMaxSeconds * rate) {
      return vm::Fail(vm::Errc::kTooLong, "'" + path + "' holds more than two hours of sound");
    }
  }
  if (mono.empty()) return vm::Fail(vm::Errc::kBadValue, "'" + path + "' has no sound in it");
  return Resampled(mono, rate);
}

}  // namespace sound
