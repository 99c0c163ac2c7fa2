#include "ssm/engines/espeak_engine.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <mutex>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "embedded/espeak_ipa.h"
#include "embedded/espeak_ja.h"
#include "embedded/espeak_voices.h"
#include "ssm/engines/piece_engine.h"
#include "ssm/process/child_process.h"
#include "ssm/voice/phoneme_map.h"
#include "ssm/voice/pronounced_text.h"
#include "ssm/voice/resample.h"
#ifdef SSM_HAS_MECAB
#include "ssm/japanese/reader.h"
#endif

namespace ssm {
namespace {

constexpr double kWordsPerMinute = 150;
constexpr std::string_view kNamePrefix = "espeak-";

/// What is spoken, and how its words are written.
struct Script {
  std::string text;
  std::vector<std::string> words;  // empty: as in `text`
  std::string unspoken;
  struct Pronounced {
    std::size_t first, last;  // characters of `text`
    std::string written;
  };
  std::vector<Pronounced> pronounced{};
};

struct Answer {
  std::int64_t rate = 0;
  std::vector<std::int16_t> samples;
  vm::PhonemeList phonemes;  // by espeak-ng's names
  struct Word {
    Millis at{0};
    std::size_t character = 0, count = 0;
  };
  std::vector<Word> words;
};

PhonemeMap LoadMap(std::string_view table, const std::string& file) {
  auto map = PhonemeMap::Parse(table, file);
  if (!map) throw std::runtime_error(map.error().text);
  return std::move(*map);
}

/// The byte at which a character of UTF-8 text begins; its size if there are fewer.
std::size_t ByteOf(std::string_view text, std::size_t character) {
  std::size_t at = 0;
  for (; at < text.size(); ++at) {
    const bool begins = (static_cast<unsigned char>(text[at]) & 0xC0) != 0x80;
    if (begins && character-- == 0) break;
  }
  return at;
}

std::size_t Characters(std::string_view text) {
  std::size_t count = 0;
  for (const char c : text) count += (static_cast<unsigned char>(c) & 0xC0) != 0x80 ? 1 : 0;
  return count;
}

vm::Error BadAnswer(const std::string& what) {
  return {vm::Errc::kUnavailable, "the helper for espeak-ng answered '" + what + "'", 0};
}

/// The conversation with the helper program. Started when first needed.
class Helper {
 public:
  explicit Helper(const EspeakOptions& options) : options_(options) {}

  vm::Result<Answer> Say(const std::string& request, const std::atomic<bool>& cancelled) {
    for (int attempt = 0;; ++attempt) {
      auto answer = TrySay(request, cancelled);
      if (answer) return answer;
      // What it says itself is no reason to end it.
      if (std::exchange(spoke_, false)) return answer;
      process_.reset();
      // It may have died long ago; a new one gets the same sentence once.
      if (attempt > 0 || answer.error().code != vm::Errc::kUnavailable) return answer;
    }
  }

 private:
  vm::Result<Answer> TrySay(const std::string& request, const std::atomic<bool>& cancelled) {
    if (!process_) {
      auto started = ChildProcess::Start({options_.helper}, true);
      if (!started) return std::unexpected(started.error());
      process_ = std::move(*started);
    }
    const ChildProcess::Wait wait{ChildProcess::Clock::now() + options_.limit, &cancelled};
    if (auto sent = process_->Write(request, wait); !sent) return std::unexpected(sent.error());
    auto head = process_->ReadLine(wait);
    if (!head) return std::unexpected(head.error());
    if (head->starts_with("error ")) {
      spoke_ = true;
      return vm::Fail(vm::Errc::kUnavailable, "espeak-ng: " + head->substr(6));
    }
    return ReadSound(*head, wait);
  }

  vm::Result<Answer> ReadSound(const std::string& head, const ChildProcess::Wait& wait) {
    std::istringstream words(head);
    std::string verb;
    std::size_t frames = 0, lines = 0;
    Answer answer;
    if (!(words >> verb >> answer.rate >> frames >> lines) || verb != "sound" ||
        answer.rate < 1000 || answer.rate > 200'000 || frames > kMaxFrames || lines > kMaxLines) {
      return std::unexpected(BadAnswer(head.substr(0, 60)));
    }
    std::vector<std::pair<Millis, std::string>> starts;
    for (; lines > 0; --lines) {
      auto line = process_->ReadLine(wait);
      if (!line) return std::unexpected(line.error());
      if (!TakeLine(*line, starts, answer)) return std::unexpected(BadAnswer(*line));
    }
    auto bytes = process_->ReadBytes(frames * 2, wait);
    if (!bytes) return std::unexpected(bytes.error());
    answer.samples.resize(frames);
    std::memcpy(answer.samples.data(), bytes->data(), bytes->size());
    const Millis end(static_cast<std::int64_t>(frames) * 1000 / answer.rate);
    answer.phonemes = Durations(std::move(starts), end);
    return answer;
  }

  static bool TakeLine(const std::string& line, std::vector<std::pair<Millis, std::string>>& starts,
                       Answer& answer) {
    std::istringstream words(line);
    std::string kind, name;
    std::int64_t ms = 0;
    if (!(words >> kind >> ms) || ms < 0) return false;
    if (kind == "p" && words >> name) {
      starts.emplace_back(Millis(ms), name == "-" ? "" : name);
      return true;
    }
    Answer::Word word{Millis(ms), 0, 0};
    if (kind != "w" || !(words >> word.character >> word.count)) return false;
    answer.words.push_back(word);
    return true;
  }

  /// From where phonemes begin to how long they last. The events of one buffer are not in order.
  static vm::PhonemeList Durations(std::vector<std::pair<Millis, std::string>> starts, Millis end) {
    // (Of those at one instant the order stays; std::stable_sort is deprecated inside for clang.)
    const std::multimap<Millis, std::string> in_order(starts.begin(), starts.end());
    starts.assign(in_order.begin(), in_order.end());
    vm::PhonemeList list;
    if (starts.empty() || starts.front().first.count() > 0) {
      list.push_back({"", starts.empty() ? end : std::min(starts.front().first, end)});
    }
    for (std::size_t i = 0; i < starts.size(); ++i) {
      const Millis next = i + 1 < starts.size() ? std::min(starts[i + 1].first, end) : end;
      if (next > starts[i].first) list.push_back({starts[i].second, next - starts[i].first});
    }
    return list;
  }

  static constexpr std::size_t kMaxFrames = 3600u * 48'000u;
  static constexpr std::size_t kMaxLines = 100'000;

  const EspeakOptions options_;
  std::unique_ptr<ChildProcess> process_;
  bool spoke_ = false;  // the last failure was the helper's own word
};

class EspeakEngine final : public PieceEngine {
 public:
  explicit EspeakEngine(EspeakOptions options)
      : options_(std::move(options)),
        helper_(options_),
        ipa_(LoadMap(embedded::espeak_ipa(), "espeak_ipa.txt")),
        japanese_(LoadMap(embedded::espeak_ja(), "espeak_ja.txt")) {
    std::istringstream table{std::string(embedded::espeak_voices())};
    for (std::string line; std::getline(table, line);) {
      std::istringstream words(line);
      std::string language, voice;
      if (!(words >> language >> voice) || language.starts_with('#')) continue;
      voices_.push_back(
          {.name = std::string(kNamePrefix) + language, .language = language, .listed = false});
      names_.push_back(voice);
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
    auto answer = helper_.Say(request, cancelled);
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

  vm::Result<Script> ReadJapanese(const std::string& text) {
#ifdef SSM_HAS_MECAB
    if (!reader_) {
      auto opened = JapaneseReader::Open(options_.dictionary);
      if (!opened) return std::unexpected(opened.error());
      reader_ = std::move(*opened);
    }
    Script script;
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

  /// Pronunciations in brackets, as espeak-ng reads them: [[h@l'oU]]. Brackets of the text's own
  /// are parted.
  static vm::Result<Script> WithMnemonics(const std::string& text) {
    Script script;
    for (const TextPiece& piece : CutPronounced(text)) {
      const auto mnemonics = IpaForEspeak(piece.ipa);
      if (!piece.ipa.empty() && mnemonics) {
        const std::size_t begin = Characters(script.text);
        script.text += "[[" + *mnemonics + "]]";
        script.pronounced.push_back({begin, Characters(script.text), piece.text});
        continue;
      }
      for (const char c : piece.text) {
        if (c == '[' && script.text.ends_with('[')) script.text += ' ';
        script.text += c;
      }
    }
    return script;
  }

  Piece MakePiece(const Answer& answer, const Script& script, const PhonemeMap& map) const {
    Piece piece{.phonemes = map.Map(answer.phonemes), .unspoken = script.unspoken};
    piece.samples = Resample(answer.samples, answer.rate, kSampleRateHz);
    const Millis end = vm::TotalDuration(piece.phonemes);
    for (std::size_t i = 0; i < answer.words.size(); ++i) {
      const auto& word = answer.words[i];
      const Millis next = i + 1 < answer.words.size() ? answer.words[i + 1].at : end;
      const std::size_t begin = ByteOf(script.text, word.character);
      std::string text =
          i < script.words.size()
              ? script.words[i]
              : script.text.substr(begin, ByteOf(script.text, word.character + word.count) - begin);
      for (const auto& [first, last, written] : script.pronounced) {
        if (word.character >= first && word.character < last) text = written;
      }
      piece.words.push_back({std::move(text), std::min(word.at, end), std::min(next, end)});
    }
    return piece;
  }

  const EspeakOptions options_;
  std::mutex mutex_;  // guards the helper and the reader
  Helper helper_;
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
