#include "ssm/engines/command_engine.h"

#include <fstream>
#include <iterator>
#include <mutex>
#include <optional>
#include <sstream>
#include <utility>

#include "ssm/engines/wav_piece.h"
#include "ssm/process/child_process.h"
#include "ssm/voice/phoneme_map.h"

namespace ssm {
namespace {

std::string Number(double value) {
  std::ostringstream text;
  text << value;
  return text.str();
}

bool Replace(std::string& text, const std::string& name, const std::string& value) {
  bool found = false;
  for (std::size_t at = 0; (at = text.find(name, at)) != std::string::npos; at += value.size()) {
    text.replace(at, name.size(), value);
    found = true;
  }
  return found;
}

class CommandEngine final : public PieceEngine {
 public:
  CommandEngine(CommandOptions options, std::optional<PhonemeMap> map)
      : options_(std::move(options)),
        map_(std::move(map)),
        aligner_({.program = options_.aligner}),
        voices_{{.name = options_.name, .language = options_.language, .female = options_.female}} {
  }

  const std::vector<VoiceInfo>& voices() const override { return voices_; }

 protected:
  vm::Result<Piece> Speak(const SpeechSpan& span, const std::atomic<bool>& cancelled) override {
    const std::lock_guard lock(mutex_);
    const TemporaryFolder folder;
    const std::string wav = folder.File("sound.wav"), labels = folder.File("labels.txt");
    bool wav_file = false, label_file = false;
    std::vector<std::string> argv = options_.argv;
    for (std::string& word : argv) {
      wav_file = Replace(word, "{wav}", wav) || wav_file;
      label_file = Replace(word, "{labels}", labels) || label_file;
      Replace(word, "{rate}", Number(1 / span.stretch));
      Replace(word, "{pitch}", Number(span.pitch));
      Replace(word, "{language}", options_.language);
      Replace(word, "{voice}", options_.name);
    }
    auto output =
        RunProgram({.argv = argv, .input = span.text + "\n", .limit = options_.limit}, &cancelled);
    if (!output) return std::unexpected(output.error());
    std::string phonemes;
    if (!wav_file) {
      std::ofstream(wav, std::ios::binary) << *output;
    } else {
      phonemes = std::move(*output);
    }
    if (label_file) {
      std::ifstream file(labels);
      phonemes.assign(std::istreambuf_iterator<char>(file), {});
    }
    return MakePiece(span, wav, std::move(phonemes), cancelled);
  }

 private:
  vm::Result<Piece> MakePiece(const SpeechSpan& span, const std::string& wav, std::string phonemes,
                              const std::atomic<bool>& cancelled) {
    auto samples = ReadSoundFile(wav);
    if (!samples) {
      return vm::Fail(vm::Errc::kUnavailable,
                      "program '" + options_.argv[0] + "' gave no sound: " + samples.error().text);
    }
    for (char& c : phonemes) c = c == '\n' || c == '\r' ? ' ' : c;
    Piece piece;
    if (phonemes.find_first_not_of(' ') != std::string::npos) {
      auto list = vm::ParsePhonemes(phonemes);
      if (!list) {
        return vm::Fail(list.error().code,
                        "phonemes of program '" + options_.argv[0] + "': " + list.error().text);
      }
      piece.phonemes = map_ ? map_->Map(*list) : std::move(*list);
    } else if (!options_.aligner.empty()) {
      auto aligned = aligner_.Align(wav, span.text, cancelled);
      if (!aligned) return aligned;
      piece = std::move(*aligned);
    } else {
      return vm::Fail(vm::Errc::kUnavailable,
                      "program '" + options_.argv[0] + "' gave no phonemes, expected name[ms] ...");
    }
    FitToSound(piece.phonemes, *samples);
    if (piece.words.empty()) piece.words = GuessWords(span.text, piece.phonemes);
    piece.samples = std::move(*samples);
    return piece;
  }

  const CommandOptions options_;
  const std::optional<PhonemeMap> map_;
  std::mutex mutex_;  // guards the aligner
  Aligner aligner_;
  const std::vector<VoiceInfo> voices_;
};

}  // namespace

vm::Result<std::unique_ptr<SpeechEngine>> MakeCommandEngine(CommandOptions options) {
  if (options.argv.empty()) {
    return vm::Fail(vm::Errc::kBadValue, "voice '" + options.name + "' names no program");
  }
  std::optional<PhonemeMap> map;
  if (!options.table.empty()) {
    auto parsed = PhonemeMap::Parse(options.table, options.table_name);
    if (!parsed) return std::unexpected(parsed.error());
    map = std::move(*parsed);
  }
  return std::make_unique<CommandEngine>(std::move(options), std::move(map));
}

}  // namespace ssm
