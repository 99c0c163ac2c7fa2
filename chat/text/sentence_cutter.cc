#include "chat/text/sentence_cutter.h"

#include <algorithm>
#include <utility>

#include "chat/text/table_lines.h"
#include "vm_protocol/core/lower_case.h"
#include "vm_protocol/core/utf8.h"

namespace chat {
namespace {

constexpr std::size_t kNone = std::string::npos;
constexpr std::size_t kLeastPiece = 60;  // bytes before a cut where no sentence ends

constexpr std::u32string_view kWideStops = U"。！？｡";
constexpr std::u32string_view kLatinStops = U".!?…";
constexpr std::u32string_view kClosers = U"\"')]}”’»」』）】〉》";
constexpr std::u32string_view kOpeners = U"「『（";
constexpr std::u32string_view kWideClosers = U"」』）";
/// After a Japanese quote these go on with the sentence it stands in.
constexpr std::u32string_view kGoOn = U"とっては、，がをにのもでや";

bool IsBlank(char32_t sign) { return sign == U' ' || sign == U'\t' || sign == U'　'; }

bool IsSmall(char32_t sign) {
  return (sign >= U'a' && sign <= U'z') || (sign >= U'ß' && sign <= U'ÿ' && sign != U'÷');
}

/// Signs that are pictures, or say how one looks.
bool IsPicture(char32_t sign) {
  return (sign >= 0x1F000 && sign <= 0x1FAFF) || (sign >= 0x2600 && sign <= 0x27BF) ||
         (sign >= 0x2190 && sign <= 0x21FF) || (sign >= 0x2B00 && sign <= 0x2BFF) ||
         (sign >= 0xFE00 && sign <= 0xFE0F) || sign == 0x200D || sign == 0x20E3 ||
         (sign >= 0xE0000 && sign <= 0xE007F);
}

/// Neither shown nor spoken: controls, marks of direction, signs without width, U+FFFD.
bool IsInvisible(char32_t sign) {
  return sign < 0x20 || (sign >= 0x7F && sign < 0xA0) || (sign >= 0x200B && sign <= 0x200F) ||
         (sign >= 0x2028 && sign <= 0x202E) || (sign >= 0x2060 && sign <= 0x206F) ||
         sign == 0xFEFF || sign == 0xFFFD;
}

std::size_t SkipSigns(std::string_view text, std::size_t at, std::u32string_view signs) {
  while (at < text.size()) {
    const vm::CodePoint sign = vm::SignAt(text, at);
    if (!signs.contains(sign.value)) break;
    at += sign.length;
  }
  return at;
}

std::size_t SkipBlanks(std::string_view text, std::size_t at) {
  while (at < text.size() && IsBlank(vm::SignAt(text, at).value)) {
    at += vm::SignAt(text, at).length;
  }
  return at;
}

}  // namespace

bool Sentence::HasWords() const {
  return std::ranges::any_of(vm::SignsOf(text), [](char32_t sign) {
    return (sign >= U'0' && sign <= U'9') || (sign >= U'a' && sign <= U'z') ||
           (sign >= U'A' && sign <= U'Z') ||
           (sign >= 0xC0 && !(sign >= 0x2000 && sign <= 0x206F) &&
            !(sign >= 0x3000 && sign <= 0x3004) && !(sign >= 0x3008 && sign <= 0x3020) &&
            !(sign >= 0xFF01 && sign <= 0xFF0F) && !(sign >= 0xFF1A && sign <= 0xFF20));
  });
}

Abbreviations ParseAbbreviations(std::string_view table) {
  Abbreviations abbreviations;
  for (const TableLine& line : TableLines(table)) {
    for (const std::string_view word : SplitAt(line.text, " \t"))
      abbreviations.insert(vm::LowerCase(word));
  }
  return abbreviations;
}

void SentenceCutter::AddSign(char32_t sign) {
  if (sign == U'\n') {
    line_start_ = true;
    dash_ = false;
    if (!text_.empty() && text_.back() != '\n') text_ += '\n';
    return;
  }
  if (sign == U'\t' || sign == U'<' || sign == U'>' || sign == U'|') sign = U' ';
  if (sign == U'*' || sign == U'`' || sign == U'~' || IsPicture(sign) || IsInvisible(sign)) return;
  if (line_start_) {
    if (sign == U'#' || sign == U'•') return;
    if (sign == U'-' && !dash_) {
      dash_ = true;
      return;
    }
    if (IsBlank(sign)) {
      dash_ = false;  // "- " before an item of a list
      return;
    }
    line_start_ = false;
    if (std::exchange(dash_, false)) text_ += '-';
  }
  if (IsBlank(sign) && (text_.ends_with(' ') || text_.ends_with('\n'))) return;
  vm::AppendUtf8(text_, sign);
}

void SentenceCutter::Feed(std::string_view text) {
  for (std::size_t at = 0; at < text.size();) {
    const vm::CodePoint sign = vm::SignAt(text, at);
    AddSign(sign.value);
    at += sign.length;
  }
}

void SentenceCutter::Mark(Cue cue) { marks_.push_back({text_.size(), std::move(cue)}); }

/// The word before the full stop is one that is written with it, an initial, or the number of a
/// list.
bool SentenceCutter::IsAbbreviated(std::size_t stop) const {
  const std::size_t blank = text_.find_last_of(" \t\n\"'([“‘", stop == 0 ? 0 : stop - 1);
  const std::size_t begin = blank == kNone || blank >= stop ? 0 : blank + 1;
  const std::string word = text_.substr(begin, stop - begin);
  if (word.empty()) return false;
  if (word.size() == 1 && word[0] >= 'A' && word[0] <= 'Z') return word != "I";
  const bool number = std::ranges::all_of(word, [](char c) { return c >= '0' && c <= '9'; });
  if (number) return SkipBlanks(text_, 0) == begin && word.size() <= 2;
  const std::size_t next = SkipBlanks(text_, stop + 1);
  const bool before_number = next < text_.size() && text_[next] >= '0' && text_[next] <= '9';
  const std::string small = vm::LowerCase(word);
  return abbreviations_.contains(small) || (before_number && abbreviations_.contains(small + "#"));
}

/// Stops of Latin letters from `stop` on, with what closes, reach to `after`. `wait`: more of the
/// text has to come first.
bool SentenceCutter::EndsLatin(std::size_t stop, std::size_t after, bool final, bool& wait) const {
  if (after == text_.size()) {
    wait = !final;
    return final;
  }
  const char32_t next = vm::SignAt(text_, after).value;
  if (next == U'\n') return true;
  if (!IsBlank(next)) return next >= 0x3000 && next < 0xFF00;  // Japanese follows without a blank
  const std::size_t word = SkipBlanks(text_, after);
  if (word == text_.size()) {
    wait = !final;
    return final;
  }
  if (IsSmall(vm::SignAt(text_, word).value)) return false;
  const bool one = text_[stop] == '.' && (stop + 1 == text_.size() || text_[stop + 1] != '.');
  return !(one && IsAbbreviated(stop));
}

/// Where the first sentence ends; kNone: it has not come to its end.
std::size_t SentenceCutter::FindEnd(bool final) const {
  int depth = 0;
  for (std::size_t at = 0; at < text_.size();) {
    const vm::CodePoint sign = vm::SignAt(text_, at);
    if (sign.value == U'\n') return at + 1;
    if (kOpeners.contains(sign.value)) ++depth;
    if (kWideClosers.contains(sign.value)) depth = std::max(0, depth - 1);
    const bool wide = kWideStops.contains(sign.value);
    if (!wide && !kLatinStops.contains(sign.value)) {
      at += sign.length;
      continue;
    }
    const std::size_t stops = SkipSigns(text_, at, wide ? kWideStops : kLatinStops);
    const std::size_t after = SkipSigns(text_, stops, kClosers);
    for (std::size_t i = stops; i < after; i += vm::SignAt(text_, i).length) {
      if (kWideClosers.contains(vm::SignAt(text_, i).value)) depth = std::max(0, depth - 1);
    }
    bool wait = false;
    if (wide) {
      if (after == text_.size()) return final ? after : kNone;
      const bool goes_on = after > stops && kGoOn.contains(vm::SignAt(text_, after).value);
      if (depth == 0 && !goes_on) return after;
    } else if (EndsLatin(at, after, final, wait)) {
      return after;
    }
    if (wait) return kNone;
    at = after;
  }
  return final && !text_.empty() ? text_.size() : kNone;
}

/// Takes the first `end` bytes off.
Sentence SentenceCutter::CutOff(std::size_t end) {
  std::size_t begin = 0;
  while (begin < end && (text_[begin] == '\n' || IsBlank(vm::SignAt(text_, begin).value))) {
    begin += vm::SignAt(text_, begin).length;
  }
  std::size_t last = end;
  while (last > begin && (text_[last - 1] == '\n' || text_[last - 1] == ' ')) --last;
  Sentence sentence{.text = text_.substr(begin, last - begin), .before = {}, .within = {}};
  std::vector<Sentence::Placed> later;
  for (auto& [at, cue] : marks_) {
    if (at >= end) {
      later.push_back({at - end, std::move(cue)});
    } else if (at <= begin) {
      sentence.before.push_back(std::move(cue));
    } else {
      sentence.within.push_back({std::min(at, last) - begin, std::move(cue)});
    }
  }
  marks_ = std::move(later);
  text_.erase(0, end);
  return sentence;
}

std::vector<Sentence> SentenceCutter::TakeUpTo(bool final) {
  std::vector<Sentence> sentences;
  while (true) {
    std::size_t end = FindEnd(final);
    if (std::min(end, text_.size()) > kMaxSentenceBytes) {
      const std::string_view head = vm::CutUtf8(text_, kMaxSentenceBytes);
      end = head.find_last_of(",;:");
      const std::size_t wide = head.rfind("、");
      if (wide != kNone && (end == kNone || wide > end)) end = wide + 2;
      if (end == kNone || end < kLeastPiece) end = head.rfind(' ');
      end = end == kNone || end < kLeastPiece ? head.size() : end + 1;
    }
    if (end == kNone) return sentences;
    Sentence sentence = CutOff(end);
    if (!sentence.text.empty() || !sentence.before.empty())
      sentences.push_back(std::move(sentence));
  }
}

std::vector<Sentence> SentenceCutter::Flush() {
  auto sentences = TakeUpTo(true);
  if (!marks_.empty()) {
    Sentence rest;
    for (auto& mark : std::exchange(marks_, {})) rest.before.push_back(std::move(mark.cue));
    sentences.push_back(std::move(rest));
  }
  text_.clear();
  line_start_ = true;
  dash_ = false;
  return sentences;
}

bool SentenceCutter::WouldEnd() const {
  const std::size_t last = text_.find_last_not_of(' ');
  if (last == kNone || FindEnd(false) != kNone) return false;
  const std::string_view text = std::string_view(text_).substr(0, last + 1);
  for (std::size_t at = 0; at < text.size();) {
    const vm::CodePoint sign = vm::SignAt(text, at);
    const bool stop = kWideStops.contains(sign.value) || kLatinStops.contains(sign.value);
    if (stop && SkipSigns(text, at + sign.length, kClosers) == text.size()) {
      return sign.value != U'.' || !IsAbbreviated(at);
    }
    at += sign.length;
  }
  return false;
}

}  // namespace chat
