#include "gateway/face/live_face.h"

#include "vm_protocol/core/utf8.h"

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
                       .weights = settings_.set->Of(moment.frame),
                       .mouth = moment.frame});
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

vm::Result<LiveRates> ReadLive(std::string_view rate, std::string_view fps) {
  const auto one_of = [](const char* name, std::string_view found,
                         std::initializer_list<unsigned> known) -> vm::Result<unsigned> {
    std::string expected;
    for (const unsigned number : known) {
      if (found == std::to_string(number)) return number;
      expected += (expected.empty() ? "" : ", ") + std::to_string(number);
    }
    return vm::Fail(vm::Errc::kBadValue, std::string(name) + ": found '" +
                                             vm::ShownUtf8(vm::CutUtf8(found, 40)) +
                                             "', expected one of " + expected);
  };
  const auto rate_hz = one_of("rate", rate, {8000, 16'000, 24'000, 44'100, 48'000});
  if (!rate_hz) return std::unexpected(rate_hz.error());
  const auto frames = one_of("fps", fps, {20, 25, 50, 100});
  if (!frames) return std::unexpected(frames.error());
  return LiveRates{*rate_hz, *frames};
}

}  // namespace gateway
