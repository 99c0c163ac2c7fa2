#include "vdm/app/track_print.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "vdm/core/mouth_sender.h"
#include "vdm/mouth/mouth_tracker.h"
#include "vdm/net/sound_classes.h"

namespace vdm {
namespace {

double MsOf(std::uint64_t sample) {
  return static_cast<double>(sample) * 1000 / static_cast<double>(kSampleRateHz);
}

/// All moments up to the sound's end; behind it silence is heard as long as the network needs.
std::vector<MouthTracker::Moment> Moments(const MouthNet& net,
                                          std::span<const std::int16_t> samples) {
  MouthTracker tracker(net);
  std::vector<MouthTracker::Moment> moments = tracker.Add(samples);
  const std::vector<std::int16_t> silence(tracker.ahead_samples() + tracker.hop_samples());
  for (MouthTracker::Moment& moment : tracker.Add(silence)) moments.push_back(std::move(moment));
  std::erase_if(moments, [&](const auto& moment) { return moment.sample >= samples.size(); });
  return moments;
}

std::string PrintTable(const std::vector<std::string>& sounds,
                       const std::vector<MouthTracker::Moment>& moments) {
  std::string text = "ms,sound,opening_mm,seal,tongue";
  for (std::size_t i = 1; i <= kMouthParameters; ++i) text += fmt::format(",m{}", i);
  text += '\n';
  for (const auto& [sample, frame] : moments) {
    const auto likeliest = std::ranges::max_element(frame.sounds) - frame.sounds.begin();
    text += fmt::format("{:g},{},{:.2f},{:.3f},{:.3f}", MsOf(sample),
                        sounds[static_cast<std::size_t>(likeliest)], frame.Opening(), frame.seal,
                        frame.tongue);
    for (const float value : frame.mouth) text += fmt::format(",{:.3f}", value);
    text += '\n';
  }
  return text;
}

std::string PrintLines(const std::vector<MouthTracker::Moment>& moments) {
  std::string text = "set MouthFrame.start = NOW\n";
  vm::Time start{0};
  MouthSender sender({.start = [&](vm::Time at) { start = at; },
                      .frame =
                          [&](double ms, const MouthFrame& frame) {
                            const double at = static_cast<double>(start.count()) / 1000 + ms;
                            text += "set MouthFrame = " + FrameText(at, frame) + "\n";
                          },
                      .moving = [](bool) {}});
  for (const auto& [sample, frame] : moments) {
    sender.Add(vm::Time(static_cast<vm::Time::rep>(MsOf(sample) * 1000)), frame);
  }
  sender.Finish();
  return text;
}

}  // namespace

std::string PrintTrack(const MouthNet& net, std::span<const std::int16_t> samples,
                       const std::string& format) {
  const auto moments = Moments(net, samples);
  return format == "csv" ? PrintTable(net.sounds, moments) : PrintLines(moments);
}

vm::Result<std::string> PrintTrack(const TriphoneModel& model, const vm::PhonemeList& phonemes,
                                   const std::string& format) {
  auto frames = MouthOf(model, phonemes);
  if (!frames) return std::unexpected(frames.error());
  std::vector<MouthTracker::Moment> moments;
  const double samples = model.step_ms * static_cast<double>(kSampleRateHz) / 1000;
  for (MouthFrame& frame : *frames) {
    const double at = samples * static_cast<double>(moments.size());
    moments.push_back({static_cast<std::uint64_t>(at), std::move(frame)});
  }
  return format == "csv" ? PrintTable(SoundClasses::Built().names(), moments) : PrintLines(moments);
}

}  // namespace vdm
