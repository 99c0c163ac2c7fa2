#include "film_dub/speech/new_speech.h"

#include <algorithm>
#include <chrono>

#include "sound/sound_file.h"
#include "ssm/process/voice_process.h"
#include "ssm/voice/wav_file.h"
#include "vdm/mouth/mouth_tracker.h"
#include "vdm/recording/recording_reader.h"

namespace filmdub {
namespace {

constexpr std::chrono::seconds kVoiceLimit{120};

vm::Result<NewSpeech> SpeechOfText(const SpeechWanted& wanted, const std::string& kept,
                                   fsm::MotionTables tables) {
  ssm::VoiceProcess voice(wanted.voice_module, kVoiceLimit);
  auto spoken = voice.Speak({.text = wanted.text, .voice = wanted.voice});
  if (!spoken) return std::unexpected(spoken.error());
  NewSpeech speech;
  speech.sound_file = kept;
  if (auto written = ssm::WriteWav(kept, spoken->samples); !written) {
    return std::unexpected(written.error());
  }
  speech.length_s = static_cast<double>(spoken->samples.size()) / ssm::kSampleRateHz;
  speech.motion = std::make_unique<fsm::FaceMotion>(std::move(tables), 1);
  speech.motion->speech.Start(vm::Time(0), spoken->phonemes, vm::Time(0));
  return speech;
}

vm::Result<NewSpeech> SpeechOfSound(const std::string& sound, fsm::MotionTables tables) {
  auto samples = sound::ReadSound(sound);
  if (!samples) return std::unexpected(samples.error());
  NewSpeech speech{.sound_file = sound,
                   .length_s = static_cast<double>(samples->size()) / vdm::kSampleRateHz};
  speech.motion = std::make_unique<fsm::FaceMotion>(std::move(tables), 1);
  const vdm::MouthNet& net =
      vdm::ShippedNet(vdm::CanMakeFeatures(vdm::FeatureKind::kPhones) ? vdm::FeatureKind::kPhones
                                                                      : vdm::FeatureKind::kMel);
  const bool words_heard =
      net.features == vdm::FeatureKind::kPhones && vdm::CanMakeFeatures(vdm::FeatureKind::kWords);
  vdm::MouthTracker tracker(net, 1,
                            words_heard ? &vdm::ShippedNet(vdm::FeatureKind::kWords) : nullptr);
  const vdm::RecordedMouth words = vdm::ReadWords(*samples, "film_dub");
  const std::size_t length = samples->size();
  samples->resize(length + tracker.ahead_samples() + tracker.hop_samples());
  for (auto& moment : tracker.Add(*samples)) {
    if (moment.sample > length) break;
    words.Blend(moment.sample, moment.frame);
    fsm::MouthPose pose{.seal = std::clamp(moment.frame.seal, 0.0F, 1.0F),
                        .tongue = std::clamp(moment.frame.tongue, 0.0F, 1.0F)};
    std::ranges::copy(moment.frame.mouth, pose.mouth.begin());
    const auto at = static_cast<std::int64_t>(moment.sample * 1'000'000 / vdm::kSampleRateHz);
    if (auto added = speech.motion->mouth_stream.Add(vm::Time(0), vm::Time(at), pose); !added) {
      return std::unexpected(added.error());
    }
  }
  return speech;
}

}  // namespace

vm::Result<NewSpeech> Prepare(const SpeechWanted& wanted, const std::string& kept) {
  auto tables = fsm::MotionTables::Load();
  if (!tables) return std::unexpected(tables.error());
  return wanted.text.empty() ? SpeechOfSound(wanted.sound, std::move(*tables))
                             : SpeechOfText(wanted, kept, std::move(*tables));
}

}  // namespace filmdub
