#include "vdm/app/track_print.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <vector>

#include "vdm/core/mouth_sender.h"
#include "vdm/core/voice_manner.h"
#include "vdm/mouth/mouth_tracker.h"
#include "vdm/net/sound_classes.h"

namespace vdm {
namespace {

double MsOf(std::uint64_t sample) {
  return static_cast<double>(sample) * 1000 / static_cast<double>(kSampleRateHz);
}

struct Shown {
  MouthTracker::Moment mouth;
  std::optional<HeadPose> head;
};

/// All moments up to the sound's end; behind it silence is heard as long as the networks need.
/// `heard`, if it is given, is called after each moment that was heard.
std::vector<Shown> Moments(
    const TrackNets& nets, const RecordedMouth& words, std::span<const std::int16_t> samples,
    const std::function<void(const MouthTracker::Moment&, const VoiceManner&)>& heard = {}) {
  MouthTracker tracker(nets.mouth, 1, nets.words);
  std::vector<Shown> shown;
  const auto show = [&](const MouthTracker::Moment& moment, const std::optional<HeadPose>& pose) {
    if (moment.sample < samples.size()) shown.push_back({moment, pose});
  };
  VoiceManner manner({.head = nets.head}, tracker.ahead_samples(), tracker.hop_samples());
  std::vector<std::int16_t> sound(samples.begin(), samples.end());
  sound.resize(sound.size() + tracker.ahead_samples() + tracker.hop_samples() +
               VoiceManner::kHeadLate);
  const bool mouth_alone = nets.head == nullptr && !heard;
  if (!mouth_alone) manner.Add(sound);
  for (MouthTracker::Moment& moment : tracker.Add(sound)) {
    words.Blend(moment.sample, moment.frame);
    if (mouth_alone) {
      show(moment, std::nullopt);
      continue;
    }
    manner.Take(moment, {.wait = VoiceManner::kHeadLate}, show);
    if (heard && moment.sample < samples.size()) heard(moment, manner);
  }
  return shown;
}

std::string HeadCells(const HeadPose& head) {
  return fmt::format(",{:.3f},{:.3f},{:.3f},{:.3f}", head.angles[0], head.angles[1], head.angles[2],
                     head.brow);
}

std::string PrintProsody(const TrackNets& nets, std::span<const std::int16_t> samples) {
  std::string text =
      "ms,hz,voicing,power_db,tilt_db,speech,syllable,pitch_above,power_above,position\n";
  Moments(nets, {}, samples, [&](const auto& moment, const VoiceManner& manner) {
    const ProsodyFrame& now = manner.prosody();
    const SpeakerUsual& usual = manner.stream().usual();
    const double pitch = now.hz > 0 ? usual.log_hz.Above(std::log(static_cast<double>(now.hz))) : 0;
    text += fmt::format("{:g},{:.2f},{:.3f},{:.2f},{:.2f},{:.3f},{},{:.3f},{:.3f},{:.3f}\n",
                        MsOf(manner.stream().at()), now.hz, now.voicing, now.power_db, now.tilt_db,
                        1 - moment.frame.sounds.front(), manner.stream().syllable_ended() ? 1 : 0,
                        pitch, usual.power_db.Above(static_cast<double>(now.power_db)),
                        manner.stream().phrases().position01());
  });
  return text;
}

std::string PrintTable(const std::vector<std::string>& sounds, const std::vector<Shown>& moments,
                       bool with_head) {
  std::string text = "ms,sound,opening_mm,seal,tongue";
  for (std::size_t i = 1; i <= kMouthParameters; ++i) text += fmt::format(",m{}", i);
  if (with_head) text += ",down,right,tilt,brow";
  text += '\n';
  for (const auto& [mouth, pose] : moments) {
    const auto& [sample, frame] = mouth;
    const auto likeliest = std::ranges::max_element(frame.sounds) - frame.sounds.begin();
    text += fmt::format("{:g},{},{:.2f},{:.3f},{:.3f}", MsOf(sample),
                        sounds[static_cast<std::size_t>(likeliest)], frame.Opening(), frame.seal,
                        frame.tongue);
    for (const float value : frame.mouth) text += fmt::format(",{:.3f}", value);
    if (pose) text += HeadCells(*pose);
    text += '\n';
  }
  return text;
}

std::string PrintLines(const std::vector<Shown>& moments) {
  std::string text = "set MouthFrame.start = NOW\n";
  vm::Time start{0};
  MouthSender sender({.start = [&](vm::Time at) { start = at; },
                      .frame =
                          [&](double ms, const MouthFrame& frame, const auto& pose) {
                            const double at = static_cast<double>(start.count()) / 1000 + ms;
                            text += "set MouthFrame = " + FrameText(at, frame, pose) + "\n";
                          },
                      .moving = [](bool) {}});
  for (const auto& [mouth, pose] : moments) {
    const auto at = static_cast<vm::Time::rep>(MsOf(mouth.sample) * 1000);
    sender.Add(vm::Time(at), mouth.frame, pose);
  }
  sender.Finish();
  return text;
}

}  // namespace

std::string PrintTrack(const TrackNets& nets, const RecordedMouth& words,
                       std::span<const std::int16_t> samples, const std::string& format) {
  if (format == "prosody") return PrintProsody({nets.mouth, nets.words, nullptr}, samples);
  const auto moments = Moments(nets, words, samples);
  return format == "csv" ? PrintTable(nets.mouth.sounds, moments, nets.head != nullptr)
                         : PrintLines(moments);
}

vm::Result<std::string> PrintTrack(const TriphoneModel& model, const vm::PhonemeList& phonemes,
                                   const std::string& format) {
  auto frames = MouthOf(model, phonemes);
  if (!frames) return std::unexpected(frames.error());
  std::vector<Shown> moments;
  const double samples = model.step_ms * static_cast<double>(kSampleRateHz) / 1000;
  for (MouthFrame& frame : *frames) {
    const double at = samples * static_cast<double>(moments.size());
    moments.push_back({{static_cast<std::uint64_t>(at), std::move(frame)}, std::nullopt});
  }
  return format == "csv" ? PrintTable(SoundClasses::Built().names(), moments, false)
                         : PrintLines(moments);
}

}  // namespace vdm
