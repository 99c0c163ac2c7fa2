#include "ssm/engines/open_jtalk_engine.h"

#include <cmath>
#include <utility>

#include "ssm/engines/voice_file.h"
#include "ssm/engines/wav_piece.h"

namespace ssm {
namespace {

class OpenJtalkEngine final : public PieceEngine {
 public:
  explicit OpenJtalkEngine(OpenJtalkOptions options)
      : options_(std::move(options)),
        voices_{{.name = options_.name, .language = "ja", .female = options_.female}} {}

  const std::vector<VoiceInfo>& voices() const override { return voices_; }

 protected:
  vm::Result<Piece> Speak(const SpeechSpan& span, const std::atomic<bool>& cancelled) override {
    const TemporaryFolder folder;
    const std::string wav = folder.File("sound.wav");
    auto analysis = RunOpenJtalk(options_, span.text,
                                 {"-r", NumberText(1 / span.stretch), "-fm",
                                  NumberText(12 * std::log2(span.pitch)), "-ow", wav},
                                 cancelled);
    if (!analysis) return std::unexpected(analysis.error());
    Piece piece{.phonemes = PhonemesOf(*analysis, analysis->ends)};
    if (piece.phonemes.empty()) {
      piece.unspoken = "open_jtalk found nothing to read in: " + span.text.substr(0, 60);
      return piece;
    }
    piece.words = WordsOf(*analysis, piece.phonemes);
    auto samples = ReadSoundFile(wav);
    if (!samples) return std::unexpected(samples.error());
    piece.samples = std::move(*samples);
    FitToSound(piece.phonemes, piece.samples);
    return piece;
  }

 private:
  const OpenJtalkOptions options_;
  const std::vector<VoiceInfo> voices_;
};

}  // namespace

vm::Result<std::unique_ptr<SpeechEngine>> MakeOpenJtalkEngine(OpenJtalkOptions options) {
  if (auto voice = ReadVoiceFileHead(options.voice_file); !voice) {
    return std::unexpected(voice.error());
  }
  if (auto good = CheckOpenJtalkDictionary(options); !good) return std::unexpected(good.error());
  return std::make_unique<OpenJtalkEngine>(std::move(options));
}

}  // namespace ssm
