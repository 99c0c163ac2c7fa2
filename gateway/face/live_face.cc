#include "gateway/face/live_face.h"

namespace gateway {

LiveFace::LiveFace(const vdm::MouthNet& net, const Settings& settings)
    : net_(net), settings_(settings) {
  Clear();
}

void LiveFace::Clear() {
  tracker_ = std::make_unique<vdm::MouthTracker>(net_);
  resampler_ = std::make_unique<sound::StreamResampler>(settings_.rate_hz);
  half_.clear();
  heard_ = 0;
}

double LiveFace::heard_s() const { return static_cast<double>(heard_) / settings_.rate_hz; }

double LiveFace::ahead_s() const {
  return static_cast<double>(tracker_->ahead_samples()) / vdm::kSampleRateHz;
}

std::vector<LiveFace::Moment> LiveFace::Add(std::string_view pcm) {
  std::vector<std::int16_t> samples;
  samples.reserve(pcm.size() / 2 + 1);
  for (const char c : pcm) {
    if (half_.empty()) {
      half_ = c;
      continue;
    }
    const unsigned low = static_cast<unsigned char>(half_[0]);
    const unsigned high = static_cast<unsigned char>(c);
    samples.push_back(static_cast<std::int16_t>(static_cast<std::uint16_t>(low | high << 8)));
    half_.clear();
  }
  return Add(samples);
}

std::vector<LiveFace::Moment> LiveFace::Add(const std::vector<std::int16_t>& samples) {
  heard_ += samples.size();
  return Track(resampler_->Add(samples));
}

std::vector<LiveFace::Moment> LiveFace::Track(std::span<const std::int16_t> samples) {
  std::vector<Moment> moments;
  const std::uint64_t every = vdm::kSampleRateHz / settings_.fps;
  for (const auto& moment : tracker_->Add(samples)) {
    if (moment.sample % every != 0) continue;
    moments.push_back({.at_s = static_cast<double>(moment.sample) / vdm::kSampleRateHz,
                       .weights = settings_.set->Of(moment.frame)});
  }
  return moments;
}

std::vector<LiveFace::Moment> LiveFace::End() {
  const std::vector<std::int16_t> silence(tracker_->ahead_samples() + tracker_->hop_samples());
  std::vector<Moment> moments = Track(silence);
  std::erase_if(moments, [end = heard_s()](const Moment& moment) { return moment.at_s > end; });
  Clear();
  return moments;
}

vm::Result<void> CheckLive(long rate_hz, long fps) {
  if (rate_hz != 8000 && rate_hz != 16'000 && rate_hz != 24'000 && rate_hz != 44'100 &&
      rate_hz != 48'000) {
    return vm::Fail(vm::Errc::kBadValue, "rate " + std::to_string(rate_hz) +
                                             " found, 8000, 16000, 24000, 44100 or 48000 expected");
  }
  if (fps != 20 && fps != 25 && fps != 50 && fps != 100) {
    return vm::Fail(vm::Errc::kBadValue,
                    "fps " + std::to_string(fps) + " found, 20, 25, 50 or 100 expected");
  }
  return {};
}

}  // namespace gateway
