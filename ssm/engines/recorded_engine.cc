#include <cctype>
#include <filesystem>
#include <fstream>
#include <map>
#include <mutex>
#include <utility>

#include "ssm/engines/command_engine.h"
#include "ssm/engines/wav_piece.h"
#include "ssm/voice/utterance.h"

namespace ssm {
namespace {

/// What counts of a text when it is looked for: letters and digits in lower case, and all that is
/// not ASCII.
std::string Key(std::string_view text) {
  std::string key;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte >= 0x80)
      key += c;
    else if (std::isalnum(byte) != 0)
      key += static_cast<char>(std::tolower(byte));
  }
  return key;
}

class RecordedEngine final : public PieceEngine {
 public:
  explicit RecordedEngine(RecordedOptions options)
      : options_(std::move(options)),
        aligner_({.program = options_.aligner}),
        voices_{{.name = options_.name,
                 .language = options_.language,
                 .female = options_.female,
                 .pitch_adjustable = false}} {
    for (const Recording& recording : options_.recordings) {
      recordings_.emplace(Key(recording.text), recording);
    }
  }

  const std::vector<VoiceInfo>& voices() const override { return voices_; }

 protected:
  vm::Result<Piece> Speak(const SpeechSpan& span, const std::atomic<bool>& cancelled) override {
    const std::lock_guard lock(mutex_);
    const std::string key = Key(span.text);
    const auto recording = recordings_.find(key);
    if (recording == recordings_.end()) {
      return vm::Fail(
          vm::Errc::kUnavailable,
          "voice '" + options_.name + "' has no recording of '" + span.text.substr(0, 60) + "'");
    }
    if (const auto known = pieces_.find(key); known != pieces_.end()) return known->second;
    auto piece = Prepare(recording->second, cancelled);
    if (piece) pieces_.emplace(key, *piece);
    return piece;
  }
  /// A recording may hold several sentences; the whole text is looked for first.
  std::vector<std::string> Sentences(const std::string& text) const override {
    if (recordings_.contains(Key(text))) return {text};
    return PieceEngine::Sentences(text);
  }

 private:
  vm::Result<Piece> Prepare(const Recording& recording, const std::atomic<bool>& cancelled) {
    auto samples = ReadSoundFile(recording.wav);
    if (!samples) return std::unexpected(samples.error());
    const auto info = ReadInfo(recording.wav);
    vm::Result<Piece> piece = Piece{};
    if (info && !info->phonemes.empty())
      piece->phonemes = info->phonemes;
    else
      piece = aligner_.Align(recording.wav, recording.text, cancelled);
    if (!piece) return piece;
    piece->samples = std::move(*samples);
    FitToSound(piece->phonemes, piece->samples);
    if (piece->words.empty()) piece->words = GuessWords(recording.text, piece->phonemes);
    return piece;
  }

  const RecordedOptions options_;
  std::mutex mutex_;  // guards what follows
  Aligner aligner_;
  std::map<std::string, Recording> recordings_;
  std::map<std::string, Piece> pieces_;
  const std::vector<VoiceInfo> voices_;
};

}  // namespace

std::unique_ptr<SpeechEngine> MakeRecordedEngine(RecordedOptions options) {
  return std::make_unique<RecordedEngine>(std::move(options));
}

}  // namespace ssm
