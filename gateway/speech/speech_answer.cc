#include "gateway/speech/speech_answer.h"

#include <cmath>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "gateway/face/live_face.h"
#include "ssm/engines/wav_piece.h"
#include "ssm/process/child_process.h"
#include "ssm/voice/resample.h"
#include "ssm/voice/wav_file.h"
#include "vdm/net/sound_classes.h"
#include "vm_protocol/runtime/base64.h"

namespace gateway {
namespace {

using nlohmann::json;

constexpr std::int64_t kPcmHz = 24'000;  // what clients of this API take `pcm` for

double Seconds(ssm::Millis time) { return static_cast<double>(time.count()) / 1000; }
double Rounded(double value) { return std::round(value * 1000) / 1000; }

std::string Pcm(const std::vector<std::int16_t>& samples) {
  std::string bytes;
  for (const std::int16_t sample : ssm::Resample(samples, ssm::kSampleRateHz, kPcmHz)) {
    bytes += static_cast<char>(sample & 0xFF);
    bytes += static_cast<char>(sample >> 8 & 0xFF);
  }
  return bytes;
}

vm::Result<std::string> Sound(const SoundFormat& format, const std::vector<std::int16_t>& samples,
                              const std::atomic<bool>& cancelled) {
  if (format.name == "pcm") return Pcm(samples);
  const ssm::TemporaryFolder folder;
  const std::string wav = folder.File("sound.wav");
  if (auto written = ssm::WriteWav(wav, samples); !written) {
    return std::unexpected(written.error());
  }
  if (!format.muxer.empty()) {
    return ssm::RunProgram({.argv = {"ffmpeg", "-v", "error", "-nostdin", "-i", wav, "-f",
                                     std::string(format.muxer), "-"},
                            .limit = std::chrono::milliseconds(30'000)},
                           &cancelled);
  }
  std::ifstream file(wav, std::ios::binary);
  return std::string(std::istreambuf_iterator<char>(file), {});
}

/// Phonemes, and what they are in a set of visemes, with their times in seconds.
void AddTimes(const vm::PhonemeList& list, const WeightSet& set, json& answer) {
  json phonemes = json::array(), visemes = json::array();
  ssm::Millis at{0};
  for (const vm::Phoneme& phoneme : list) {
    const double start = Seconds(at), end = Seconds(at + phoneme.duration);
    at += phoneme.duration;
    phonemes.push_back({{"name", phoneme.name}, {"start", start}, {"end", end}});
    if (!set.visemes()) continue;
    const std::string& viseme =
        set.names()[set.OfSound(vdm::SoundClasses::Built().Of(phoneme.name))];
    if (!visemes.empty() && visemes.back()["viseme"] == viseme) {
      visemes.back()["end"] = end;
    } else {
      visemes.push_back({{"viseme", viseme}, {"start", start}, {"end", end}});
    }
  }
  answer["phonemes"] = std::move(phonemes);
  if (set.visemes()) answer["visemes"] = std::move(visemes);
}

json Frames(const SpeechRequest& request, const ssm::Spoken& spoken, const vdm::MouthNet& net) {
  json frames = json::array();
  LiveFace face(net, {.set = request.set, .rate_hz = 16'000, .fps = request.fps});
  auto moments = face.Add(spoken.samples);
  for (auto& moment : face.End()) moments.push_back(std::move(moment));
  for (const auto& moment : moments) {
    json weights = json::array();
    for (const float weight : moment.weights) weights.push_back(Rounded(weight));
    frames.push_back({{"t", moment.at_s}, {"weights", std::move(weights)}});
  }
  return frames;
}

}  // namespace

vm::Result<SpeechAnswer> MakeSpeechAnswer(const SpeechRequest& request, const ssm::Spoken& spoken,
                                          const vdm::MouthNet& net,
                                          const std::atomic<bool>& cancelled) {
  auto sound = Sound(*request.format, spoken.samples, cancelled);
  if (!sound) return std::unexpected(sound.error());
  if (request.set == nullptr) {
    return SpeechAnswer{std::string(request.format->media_type), std::move(*sound)};
  }
  json answer{{"audio", vm::EncodeBase64(*sound)},
              {"media_type", request.format->media_type},
              {"duration", static_cast<double>(spoken.samples.size()) / ssm::kSampleRateHz},
              {"set", request.set->name()},
              {"names", request.set->names()},
              {"fps", request.fps}};
  AddTimes(spoken.phonemes, *request.set, answer);
  answer["frames"] = Frames(request, spoken, net);
  return SpeechAnswer{"application/json", answer.dump()};
}

}  // namespace gateway
