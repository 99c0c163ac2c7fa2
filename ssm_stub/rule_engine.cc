#include "ssm_stub/rule_engine.h"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include "ssm/voice/pronounced_text.h"
#include "ssm_stub/english_rules.h"
#include "ssm_stub/japanese_rules.h"
#include "ssm_stub/phoneme_table.h"
#include "vm_protocol/core/utf8.h"

namespace ssm_stub {
namespace {

enum class Kind { kBlank, kKana, kLatin, kDigit, kSign, kUnreadable };

bool IsLatin(char32_t c) {
  // With the accented letters, and the macrons of romaji.
  return (c >= U'A' && c <= U'Z') || (c >= U'a' && c <= U'z') ||
         (c >= 0xC0 && c <= 0x17F && c != 0xD7 && c != 0xF7);
}

Kind KindOf(char32_t c) {
  if (IsKana(c)) return Kind::kKana;
  if (IsLatin(c)) return Kind::kLatin;
  if (c >= U'0' && c <= U'9') return Kind::kDigit;
  if (PauseOf(c).count() > 0) return Kind::kSign;
  if (c <= U' ' || c == 0x3000 || c == 0xA0) return Kind::kBlank;
  // Ideographs, Hangul and whatever else people write words with; signs and emoji are silent.
  const bool letters = (c >= 0x370 && c < 0x2000) || (c >= 0x3400 && c < 0xD7FF) ||
                       (c >= 0xF900 && c < 0xFB00) || (c >= 0x20000 && c < 0x32000);
  return letters || c == U'々' ? Kind::kUnreadable : Kind::kSign;
}

/// Full-width letters and digits as their ASCII forms.
char32_t HalfWidth(char32_t c) {
  const bool wide =
      (c >= U'０' && c <= U'９') || (c >= U'Ａ' && c <= U'Ｚ') || (c >= U'ａ' && c <= U'ｚ');
  return wide ? c - (U'Ａ' - U'A') : c;
}

struct Token {
  Kind kind;
  std::u32string text;
};

/// Runs of letters and kana; everything else by the character.
std::vector<Token> Tokens(std::u32string_view text) {
  std::vector<Token> tokens;
  for (std::size_t at = 0; at < text.size(); ++at) {
    const char32_t c = HalfWidth(text[at]);
    Kind kind = KindOf(c);
    const bool in_word = !tokens.empty() && tokens.back().kind == Kind::kLatin;
    const bool letter_follows =
        at + 1 < text.size() && KindOf(HalfWidth(text[at + 1])) == Kind::kLatin;
    if ((c == U'\'' || c == 0x2019) && in_word && letter_follows) {
      tokens.back().text += U'\'';
      continue;
    }
    // A full stop or comma within a number is none of the sentence.
    const bool digits_around = kind == Kind::kSign && !tokens.empty() &&
                               tokens.back().kind == Kind::kDigit && at + 1 < text.size() &&
                               KindOf(text[at + 1]) == Kind::kDigit;
    if (digits_around) kind = Kind::kBlank;
    const bool runs = kind == Kind::kKana || kind == Kind::kLatin;
    if (runs && !tokens.empty() && tokens.back().kind == kind) {
      tokens.back().text += c;
    } else {
      tokens.push_back({kind, std::u32string(1, c)});
    }
  }
  return tokens;
}

std::string LowerAscii(std::u32string_view word) {
  std::string lower = vm::Utf8Of(word);
  for (char& c : lower) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c + ('a' - 'A'));
  }
  return lower;
}

bool IsJapanese(const std::vector<Token>& tokens) {
  std::size_t phonemes = 0;
  bool romaji = true;
  for (const Token& token : tokens) {
    if (token.kind == Kind::kKana) return true;
    if (token.kind != Kind::kLatin) continue;
    const auto read = FromRomaji(token.text);
    romaji = romaji && read && !LooksEnglish(LowerAscii(token.text));
    if (read) phonemes += read->size();
  }
  return romaji && phonemes >= 3;
}

/// Letters without their accents, as the English rules know them.
std::string PlainLatin(std::u32string_view word) {
  static constexpr std::string_view kPlain =
      "AAAAAAACEEEEIIIIDNOOOOOxOUUUUYTsaaaaaaaceeeeiiiidnooooo/ouuuuyty";
  std::string plain;
  for (const char32_t c : word) {
    plain += c < 0x80 ? static_cast<char>(c) : c >= 0xC0 && c <= 0xFF ? kPlain[c - 0xC0] : 'e';
  }
  return plain;
}

class Speller {
 public:
  explicit Speller(bool japanese) : japanese_(japanese) { Pause(kEdgePause, 1); }

  void Silence(ssm::Millis length) { Pause(length, 1); }
  void Mark(const std::string& name) {
    if (!name.empty()) plan_.marks.push_back({name, at_});
  }

  void Say(const Token& token, double stretch) {
    switch (token.kind) {
      case Kind::kBlank:
        return;
      case Kind::kSign:
        return Pause(PauseOf(token.text[0]), stretch);
      case Kind::kKana:
        return Word(token, FromKana(token.text), stretch);
      case Kind::kDigit:
        return Word(token,
                    japanese_ ? FromDigitJapanese(token.text[0])
                              : FromDigitEnglish(static_cast<char>(token.text[0])),
                    stretch);
      case Kind::kLatin: {
        auto romaji = japanese_ ? FromRomaji(token.text) : std::nullopt;
        return Word(token, romaji ? std::move(*romaji) : FromEnglishWord(PlainLatin(token.text)),
                    stretch);
      }
      case Kind::kUnreadable:
        if (unreadable_.size() < kNamed) unreadable_ += vm::Utf8Of(token.text);
        return Word(token, UnreadablePhonemes(), stretch);
    }
  }

  ssm::SpeechPlan Finish() {
    if (!spoke_) {
      const ssm::Millis asked = vm::TotalDuration(plan_.phonemes) - kEdgePause;
      plan_.phonemes = {{"pau", std::max(asked, ssm::kEmptyPause)}};
      for (ssm::MarkTime& mark : plan_.marks) mark.at = std::min(mark.at, asked);
      return std::move(plan_);
    }
    Pause(kEdgePause, 1);
    // The edges have the language's own name for silence.
    if (japanese_) plan_.phonemes.front().name = plan_.phonemes.back().name = "sil";
    if (!unreadable_.empty()) {
      plan_.unspoken = "there is no reading here for: " + unreadable_ + " (spoken as a u)";
    }
    return std::move(plan_);
  }

 private:
  static constexpr std::size_t kNamed = 30;  // bytes of unreadable characters that are named

  void Word(const Token& token, const PhonemeNames& names, double stretch) {
    if (names.empty()) return;
    const ssm::Millis start = at_;
    for (const std::string& name : names) Add(name, PhonemeLength(name), stretch);
    plan_.words.push_back({vm::Utf8Of(token.text), start, at_});
    spoke_ = true;
  }
  void Add(const std::string& name, Millis length, double stretch) {
    const Millis stretched(
        std::max(1L, std::lround(static_cast<double>(length.count()) * stretch)));
    at_ += stretched;
    plan_.phonemes.push_back({name, stretched});
  }
  void Pause(Millis length, double stretch) {
    if (length.count() == 0) return;
    if (!plan_.phonemes.empty() && plan_.phonemes.back().name == "pau") {
      const auto more = Millis(std::lround(static_cast<double>(length.count()) * stretch));
      plan_.phonemes.back().duration += more;
      at_ += more;
    } else {
      Add("pau", length, stretch);
    }
  }

  const bool japanese_;
  bool spoke_ = false;
  ssm::Millis at_{0};
  std::string unreadable_;
  ssm::SpeechPlan plan_;
};

class RuleEngine final : public ssm::SpeechEngine {
 public:
  const std::vector<ssm::VoiceInfo>& voices() const override { return voices_; }
  /// Any voice reads kana and romaji as well.
  bool Speaks(const std::string& language) const override {
    return language == "en" || language == "ja";
  }

  vm::Result<ssm::SpeechPlan> Plan(const std::vector<ssm::SpeechSpan>& spans,
                                   const std::atomic<bool>&) override {
    std::vector<std::vector<Token>> tokens;
    std::vector<Token> all;
    for (const ssm::SpeechSpan& span : spans) {
      tokens.push_back(Tokens(vm::SignsOf(ssm::AsWritten(span.text))));
      all.insert(all.end(), tokens.back().begin(), tokens.back().end());
    }
    Speller speller(IsJapanese(all));
    for (std::size_t i = 0; i < spans.size(); ++i) {
      speller.Silence(spans[i].pause_before);
      speller.Mark(spans[i].mark);
      for (const Token& token : tokens[i]) speller.Say(token, spans[i].stretch);
    }
    return speller.Finish();
  }

  vm::Result<void> Render(const ssm::SpeechPlan&, ssm::SampleBuffer& samples) override {
    samples.Finish();
    return {};
  }

 private:
  const std::vector<ssm::VoiceInfo> voices_ = {{.name = "slt", .language = "en", .female = true},
                                               {.name = "rms", .language = "en"},
                                               {.name = "awb", .language = "en"},
                                               {.name = "kal16", .language = "en"}};
};

}  // namespace

std::unique_ptr<ssm::SpeechEngine> MakeRuleEngine() { return std::make_unique<RuleEngine>(); }

}  // namespace ssm_stub
