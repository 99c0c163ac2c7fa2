#include "ssm/engines/espeak_engine.h"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "embedded/espeak_ipa.h"
#include "embedded/espeak_ja.h"
#include "embedded/espeak_voices.h"
#include "ssm/engines/espeak_link.h"
#include "ssm/engines/piece_engine.h"
#include "ssm/voice/phoneme_map.h"
#include "ssm/voice/pronounced_text.h"
#include "ssm/voice/resample.h"
#include "ssm/voice/word_signs.h"
#include "vm_protocol/core/utf8.h"
#ifdef SSM_HAS_MECAB
#include "ssm/japanese/reader.h"
#endif

namespace ssm {
namespace {

constexpr double kWordsPerMinute = 150;
constexpr std::string_view kNamePrefix = "espeak-";

/// What is spoken, and how its words are written.
struct SpokenText {
  std::string text;
  std::vector<std::string> words;  // empty: as in `text`
  std::string unspoken;
  struct Pronounced {
    std::size_t first, last;  // characters of `text`
    std::string written;
  };
  std::vector<Pronounced> pronounced{};
};

PhonemeMap LoadMap(std::string_view table, const std::string& file) {
  auto map = PhonemeMap::Parse(table, file);
  if (!map) throw std::runtime_error(map.error().text);
  return std::move(*map);
}

class EspeakEngine final : public PieceEngine {
 public:
  explicit EspeakEngine(EspeakOptions options)
      : options_(std::move(options)),
        link_(options_),
        ipa_(LoadMap(embedded::espeak_ipa(), "espeak_ipa.txt")),
        japanese_(LoadMap(embedded::espeak_ja(), "espeak_ja.txt")) {
    std::istringstream table{std::string(embedded::espeak_voices())};
    for (std::string line; std::getline(table, line);) {
      std::istringstream words(line);
      std::string language, voice;
      if (!(words >> language >> voice) || language.starts_with('#')) continue;
      voices_.push_back(
          {.name = std::string(kNamePrefix) + language, .language = language, .listed = false});
      names_.push_back(options_.variant.empty() ? voice : voice + "+" + options_.variant);
    }
  }

  const std::vector<VoiceInfo>& voices() const override { return voices_; }

 protected:
  bool TakesPronunciations() const override { return true; }
  vm::Result<Piece> Speak(const SpeechSpan& span, const std::atomic<bool>& cancelled) override {
    const std::lock_guard lock(mutex_);
    const auto index = IndexOf(span.voice);
    const bool japanese = voices_[index].language == "ja";
    auto script = japanese ? ReadJapanese(AsWritten(span.text)) : WithMnemonics(span.text);
    if (!script) return std::unexpected(script.error());
    if (script->text.empty()) return Piece{.unspoken = script->unspoken};
    const int wpm = static_cast<int>(std::clamp(kWordsPerMinute / span.stretch, 80.0, 450.0));
    const int pitch = static_cast<int>(std::clamp(50 + 50 * std::log2(span.pitch), 0.0, 99.0));
    const std::string request = "say " + names_[index] + " " + std::to_string(wpm) + " " +
                                std::to_string(pitch) + " " + std::to_string(script->text.size()) +
                                "\n" + script->text;
    auto answer = link_.Say(request, cancelled);
    if (!answer) return std::unexpected(answer.error());
    return MakePiece(*answer, *script, japanese ? japanese_ : ipa_);
  }

 private:
  std::size_t IndexOf(std::string_view name) const {
    for (std::size_t i = 0; i < voices_.size(); ++i) {
      if (voices_[i].name == name) return i;
    }
    return 0;
  }

  vm::Result<SpokenText> ReadJapanese(const std::string& text) {
#ifdef SSM_HAS_MECAB
    if (!reader_) {
      auto opened = JapaneseReader::Open(options_.dictionary);
      if (!opened) return std::unexpected(opened.error());
      reader_ = std::move(*opened);
    }
    SpokenText script;
    std::string unread;
    for (JapaneseWord& word : reader_->Read(text, unread)) {
      script.text += (script.text.empty() ? "" : " ") + word.kana;
      if (word.kana != "、" && word.kana != "。") script.words.push_back(std::move(word.text));
    }
    if (!unread.empty()) script.unspoken = "there is no reading for: " + unread;
    return script;
#else
    return vm::Fail(vm::Errc::kUnavailable,
                    "built without MeCab, cannot read Japanese: " + text.substr(0, 30));
#endif
  }

  /// Pronunciations in brackets, as espeak-ng reads them: [[h@l'oU]]. It reads them behind a blank
  /// only, not behind a quote or a bracket. Brackets of the text's own are parted.
  static vm::Result<SpokenText> WithMnemonics(const std::string& text) {
    SpokenText script;
    for (const TextPiece& piece : CutPronounced(text)) {
      const auto mnemonics = IpaForEspeak(piece.ipa);
      if (!piece.ipa.empty() && mnemonics) {
        if (!script.text.empty() && script.text.back() != ' ') script.text += ' ';
        const std::size_t begin = vm::SignsOf(script.text).size();
        script.text += "[[" + *mnemonics + "]]";
        script.pronounced.push_back({begin, vm::SignsOf(script.text).size(), piece.text});
        continue;
      }
      const bool behind_one = script.text.ends_with("]]") && !script.pronounced.empty();
      if (behind_one && IsWordSign(FirstSign(piece.text))) script.text += ' ';
      for (const char c : piece.text) {
        if (c == '[' && script.text.ends_with('[')) script.text += ' ';
        script.text += c;
      }
    }
    return script;
  }

  Piece MakePiece(const EspeakLink::Answer& answer, const SpokenText& script,
                  const PhonemeMap& map) const {
    Piece piece{.phonemes = map.Map(answer.phonemes), .unspoken = script.unspoken};
    piece.samples = Resample(answer.samples, answer.rate, kSampleRateHz);
    const Millis end = vm::TotalDuration(piece.phonemes);
    const std::u32string signs = vm::SignsOf(script.text);
    for (std::size_t i = 0; i < answer.words.size(); ++i) {
      const auto& word = answer.words[i];
      const Millis next = i + 1 < answer.words.size() ? answer.words[i + 1].at : end;
      std::string text =
          i < script.words.size()
              ? script.words[i]
              : vm::Utf8Of(signs.substr(std::min(word.character, signs.size()), word.count));
      for (const auto& [first, last, written] : script.pronounced) {
        if (word.character >= first && word.character < last) text = written;
      }
      piece.words.push_back({std::move(text), std::min(word.at, end), std::min(next, end)});
    }
    return piece;
  }

  const EspeakOptions options_;
  std::mutex mutex_;  // guards the helper and the reader
  EspeakLink link_;
  const PhonemeMap ipa_;
  const PhonemeMap japanese_;
  std::vector<VoiceInfo> voices_;
  std::vector<std::string> names_;  // espeak-ng's, beside voices_
#ifdef SSM_HAS_MECAB
  std::unique_ptr<JapaneseReader> reader_;
#endif
};

}  // namespace

std::unique_ptr<SpeechEngine> MakeEspeakEngine(EspeakOptions options) {
  return std::make_unique<EspeakEngine>(std::move(options));
}

}  // namespace ssm
