#include "ssm/engines/http_engine.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <mutex>
#include <nlohmann/json.hpp>
#include <utility>

#include "ssm/engines/aligner.h"
#include "ssm/engines/wav_piece.h"
#include "ssm/process/child_process.h"
#include "ssm/voice/resample.h"
#include "ssm/voice/wav_file.h"
#include "vm_protocol/http/answer.h"

namespace ssm {
namespace {

using nlohmann::json;
using vm::Errc;
using vm::Fail;

constexpr double kSlowest = 0.25, kFastest = 4;  // as OpenAI's API reference has it
constexpr std::size_t kMaxFrames = 600u * kSampleRateHz;

vm::Error NoSound(const std::string& expected, std::string_view found) {
  return {Errc::kBadValue, "expected " + expected + ", got '" + vm::ShownAnswer(found) + "'", 0};
}

vm::Result<std::vector<std::int16_t>> FromPcm(std::string_view bytes, std::int64_t rate_hz) {
  std::vector<std::int16_t> samples(bytes.size() / 2);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const unsigned low = static_cast<unsigned char>(bytes[2 * i]);
    const unsigned high = static_cast<unsigned char>(bytes[2 * i + 1]);
    samples[i] = static_cast<std::int16_t>(static_cast<std::uint16_t>(low | high << 8));
  }
  if (samples.empty()) return Fail(Errc::kBadValue, "expected sound, got nothing");
  return Resample(samples, rate_hz, kSampleRateHz);
}

class HttpEngine final : public PieceEngine {
 public:
  explicit HttpEngine(HttpVoiceOptions options)
      : options_(std::move(options)),
        more_(json::parse(options_.server.more)),
        caller_(options_.server.ca_file),
        aligner_({.program = options_.aligner}),
        voices_{{.name = options_.name,
                 .language = options_.language,
                 .female = options_.female,
                 .pitch_adjustable = false}} {}

  const std::vector<VoiceInfo>& voices() const override { return voices_; }

 protected:
  vm::Result<Piece> Speak(const SpeechSpan& span, const std::atomic<bool>& cancelled) override {
    const std::lock_guard lock(mutex_);
    auto samples = Ask(span, cancelled);
    if (!samples) {
      return Fail(samples.error().code,
                  "voice '" + options_.name + "': " + options_.server.url + ": " +
                      vm::WithoutSecret(samples.error().text, options_.server.key));
    }
    auto piece = Aligned(span.text, *samples, cancelled);
    if (!piece) return piece;
    FitToSound(piece->phonemes, *samples);
    if (piece->words.empty()) piece->words = GuessWords(span.text, piece->phonemes);
    piece->samples = std::move(*samples);
    return piece;
  }

 private:
  vm::Result<std::vector<std::int16_t>> Ask(const SpeechSpan& span,
                                            const std::atomic<bool>& cancelled) {
    json body = more_;
    body["model"] = options_.model;
    body["voice"] = options_.voice;
    body["input"] = span.text;
    body["response_format"] = options_.format;
    const double speed = std::clamp(1 / span.stretch, kSlowest, kFastest);
    if (std::abs(speed - 1) > 0.001) body["speed"] = std::round(speed * 1000) / 1000;
    vm::HttpRequest request = vm::RequestTo(options_.server);
    request.headers.push_back("Content-Type: application/json");
    request.body = body.dump(-1, ' ', false, json::error_handler_t::replace);
    auto answer = caller_.Post(request, options_.server.stall, cancelled);
    if (!answer) return std::unexpected(answer.error());
    return SoundOf(*answer, options_.format, options_.rate_hz, cancelled);
  }

  /// The phonemes of the sound; without any it is one pause, and the piece says so.
  vm::Result<Piece> Aligned(const std::string& text, const std::vector<std::int16_t>& samples,
                            const std::atomic<bool>& cancelled) {
    std::string why = "there is no program align";
    if (!options_.aligner.empty()) {
      const TemporaryFolder folder;
      const std::string wav = folder.File("sound.wav");
      if (auto written = WriteWav(wav, samples); !written) return std::unexpected(written.error());
      // The model knows English alone; of others it says what they sound like to it.
      std::vector<std::string> said{""};
      if (options_.language == "en") said.insert(said.begin(), text);
      for (const std::string& words : said) {
        auto piece = aligner_.Align(wav, words, cancelled);
        if (piece || cancelled) return piece;
        why = piece.error().text;
      }
    }
    Piece piece;
    piece.unspoken = "the face does not move to voice '" + options_.name + "': " + why;
    return piece;
  }

  const HttpVoiceOptions options_;
  const json more_;
  std::mutex mutex_;  // guards what follows
  vm::HttpCaller caller_;
  Aligner aligner_;
  const std::vector<VoiceInfo> voices_;
};

}  // namespace

vm::Result<std::vector<std::int16_t>> SoundOf(const vm::HttpAnswer& answer,
                                              const std::string& format, std::int64_t rate_hz,
                                              const std::atomic<bool>& cancelled) {
  if (answer.head.status < 200 || answer.head.status > 299) {
    return std::unexpected(vm::StatusError(answer.head, answer.body));
  }
  const auto type = answer.head.headers.find("content-type");
  if (type != answer.head.headers.end() &&
      (type->second.starts_with("text/") || type->second.starts_with("application/json"))) {
    return std::unexpected(NoSound("sound", vm::ErrorTextOf(answer.body)));
  }
  const bool wav = answer.body.starts_with("RIFF");
  vm::Result<std::vector<std::int16_t>> samples;
  if (!wav && format == "pcm") {
    samples = FromPcm(answer.body, rate_hz);
  } else if (!wav && format == "wav") {
    return std::unexpected(NoSound("WAV", answer.body));
  } else {
    const TemporaryFolder folder;
    const std::string came = folder.File(wav ? "came.wav" : "came.mp3");
    std::ofstream(came, std::ios::binary) << answer.body;
    std::string sound = came;
    if (!wav) {
      sound = folder.File("sound.wav");
      // It is told what it gets, and to open nothing else whatever that says.
      auto decoded =
          RunProgram({.argv = {"ffmpeg", "-v", "error", "-nostdin", "-protocol_whitelist", "file",
                               "-f", "mp3", "-i", came, "-ac", "1", "-t", "600", sound}},
                     &cancelled);
      if (!decoded) return Fail(Errc::kBadValue, "no mp3: " + decoded.error().text);
    }
    samples = ReadSoundFile(sound);
    if (!samples) return Fail(samples.error().code, "no sound: " + samples.error().text);
  }
  if (samples && samples->size() > kMaxFrames) {
    return Fail(Errc::kTooLong, "a sentence that lasts more than 600 s");
  }
  return samples;
}

std::unique_ptr<SpeechEngine> MakeHttpEngine(HttpVoiceOptions options) {
  return std::make_unique<HttpEngine>(std::move(options));
}

}  // namespace ssm
