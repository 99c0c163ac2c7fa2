#include "ssm/engines/open_jtalk_engine.h"

#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <sstream>
#include <utility>

#include "ssm/engines/wav_piece.h"
#include "ssm/japanese/kana.h"
#include "ssm/process/child_process.h"

namespace ssm {
namespace {

struct AnalysedWord {
  std::string text;
  std::size_t phonemes;
};

std::vector<std::string> Fields(const std::string& line) {
  std::vector<std::string> fields;
  std::istringstream stream(line);
  for (std::string field; std::getline(stream, field, ',');) fields.push_back(std::move(field));
  return fields;
}

bool IsPause(const std::string& name) { return name == "sil" || name == "pau"; }

/// Walks words and phonemes together; gives up where the counts do not agree any more.
std::vector<WordTime> PlaceWords(const std::vector<AnalysedWord>& words,
                                 const vm::PhonemeList& phonemes) {
  std::vector<WordTime> placed;
  std::size_t next = 0;
  Millis at{0};
  const auto step = [&] { at += phonemes[next++].duration; };
  for (const AnalysedWord& word : words) {
    while (next < phonemes.size() && IsPause(phonemes[next].name)) step();
    WordTime time{word.text, at, at};
    for (std::size_t i = 0; i < word.phonemes && next < phonemes.size(); ++i) {
      if (IsPause(phonemes[next].name)) break;
      step();
    }
    time.end = at;
    if (time.end == time.start) break;
    placed.push_back(std::move(time));
  }
  return placed;
}

/// "0 2700000 xx^xx-sil+ky=o/A:...": times in 100 ns, the phoneme between - and +.
bool TakeLabel(const std::string& line, Piece& piece, std::int64_t& end_ms) {
  std::istringstream fields(line);
  std::int64_t start = 0, end = 0;
  std::string label;
  if (!(fields >> start >> end >> label) || end < start || end > 36'000'000'000) return false;
  const std::size_t minus = label.find('-');
  const std::size_t plus = label.find('+', minus == std::string::npos ? 0 : minus);
  if (minus == std::string::npos || plus == std::string::npos) return false;
  const std::int64_t ms = (end + 5'000) / 10'000;
  if (ms > end_ms) {
    piece.phonemes.push_back({label.substr(minus + 1, plus - minus - 1), Millis(ms - end_ms)});
    end_ms = ms;
  }
  return true;
}

vm::Result<std::string> ReadText(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) {
    return vm::Fail(vm::Errc::kUnavailable, "cannot read '" + path + "': " + std::strerror(errno));
  }
  return std::string{std::istreambuf_iterator<char>(file), {}};
}

class OpenJtalkEngine final : public PieceEngine {
 public:
  explicit OpenJtalkEngine(OpenJtalkOptions options)
      : options_(std::move(options)),
        voices_{{.name = options_.name, .language = "ja", .female = options_.female}} {}

  const std::vector<VoiceInfo>& voices() const override { return voices_; }

 protected:
  vm::Result<Piece> Speak(const SpeechSpan& span, const std::atomic<bool>& cancelled) override {
    const TemporaryFolder folder;
    const std::string wav = folder.File("sound.wav"), trace = folder.File("trace.txt");
    std::string line = span.text;  // it reads the first line only
    for (char& c : line) c = c == '\n' ? ' ' : c;
    auto ran = RunProgram({.argv = {options_.program, "-x", options_.dictionary, "-m",
                                    options_.voice_file, "-r", Number(1 / span.stretch), "-fm",
                                    Number(12 * std::log2(span.pitch)), "-ow", wav, "-ot", trace},
                           .input = line + "\n",
                           .limit = options_.limit},
                          &cancelled);
    if (!ran) return std::unexpected(ran.error());
    auto text = ReadText(trace);
    if (!text) return std::unexpected(text.error());
    auto piece = ParseOpenJtalkTrace(*text);
    if (!piece) return piece;
    if (piece->phonemes.empty()) {
      piece->unspoken = "open_jtalk found nothing to read in: " + line.substr(0, 60);
      return piece;
    }
    auto samples = ReadSoundFile(wav);
    if (!samples) return std::unexpected(samples.error());
    piece->samples = std::move(*samples);
    FitToSound(piece->phonemes, piece->samples);
    return piece;
  }

 private:
  static std::string Number(double value) {
    std::ostringstream text;
    text << value;
    return text.str();
  }

  const OpenJtalkOptions options_;
  const std::vector<VoiceInfo> voices_;
};

}  // namespace

vm::Result<Piece> ParseOpenJtalkTrace(std::string_view trace) {
  Piece piece;
  std::vector<AnalysedWord> words;
  enum { kNone, kAnalysis, kLabels } section = kNone;
  std::int64_t end_ms = 0;
  std::size_t number = 0;
  std::istringstream lines{std::string(trace)};
  for (std::string line; std::getline(lines, line);) {
    ++number;
    if (line.starts_with('[')) {
      section = line == "[Text analysis result]" ? kAnalysis
                : line == "[Output label]"       ? kLabels
                                                 : kNone;
    } else if (section == kAnalysis && !line.empty()) {
      const auto fields = Fields(line);
      if (fields.size() < 10) continue;
      const std::size_t count = KanaToPhonemes(fields[9]).size();
      if (count > 0) words.push_back({fields[0], count});
    } else if (section == kLabels && !line.empty() && !TakeLabel(line, piece, end_ms)) {
      return vm::Fail(vm::Errc::kBadValue, "trace of open_jtalk, line " + std::to_string(number) +
                                               ": found '" + line.substr(0, 40) +
                                               "', expected START END LABEL");
    }
  }
  piece.words = PlaceWords(words, piece.phonemes);
  return piece;
}

vm::Result<std::unique_ptr<SpeechEngine>> MakeOpenJtalkEngine(OpenJtalkOptions options) {
  std::ifstream file(options.voice_file, std::ios::binary);
  if (!file) {
    return vm::Fail(vm::Errc::kUnavailable,
                    "cannot read voice file '" + options.voice_file + "': " + std::strerror(errno));
  }
  std::string head(8, '\0');
  file.read(head.data(), static_cast<std::streamsize>(head.size()));
  if (head != "[GLOBAL]") {
    return vm::Fail(vm::Errc::kBadValue,
                    "'" + options.voice_file + "' is no voice file, expected it to begin [GLOBAL]");
  }
  if (access((options.dictionary + "/sys.dic").c_str(), R_OK) != 0) {
    return vm::Fail(vm::Errc::kUnavailable, "there is no dictionary for open_jtalk in '" +
                                                options.dictionary +
                                                "' (Debian: open-jtalk-mecab-naist-jdic)");
  }
  return std::make_unique<OpenJtalkEngine>(std::move(options));
}

}  // namespace ssm
