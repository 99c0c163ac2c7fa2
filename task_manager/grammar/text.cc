#include "task_manager/grammar/text.h"

#include <utf8proc.h>

#include <algorithm>
#include <cstdlib>
#include <memory>
#include <vector>

namespace vxml::srgs {
namespace {

/// Composed and without case, by Unicode's full case folding ("Straße" and "STRASSE" become one).
/// Text that utf8proc refuses stays as it is.
std::string WithoutCase(std::string_view text) {
  constexpr auto kOptions =
      static_cast<utf8proc_option_t>(UTF8PROC_STABLE | UTF8PROC_COMPOSE | UTF8PROC_CASEFOLD);
  utf8proc_uint8_t* made = nullptr;
  const utf8proc_ssize_t length =
      utf8proc_map(reinterpret_cast<const utf8proc_uint8_t*>(text.data()),
                   static_cast<utf8proc_ssize_t>(text.size()), &made, kOptions);
  const std::unique_ptr<utf8proc_uint8_t, decltype(&std::free)> owner(made, &std::free);
  if (length < 0) return std::string(text);
  return std::string(reinterpret_cast<const char*>(made), static_cast<std::size_t>(length));
}

/// Full-width letters and figures, and other blanks and apostrophes, as ASCII has them.
char32_t Plain(char32_t c) {
  if (c >= U'A' && c <= U'Z') return c + 32;
  if (c >= 0xFF41 && c <= 0xFF5A) return c - 0xFF41 + U'a';
  if (c >= 0xFF10 && c <= 0xFF19) return c - 0xFF10 + U'0';
  if (c == 0x3000 || c == 0xA0) return U' ';
  if (c == 0x2019) return U'\'';
  return c;
}

bool IsPunctuation(char32_t c) {
  static const std::u32string_view kMarks = U".,!?;:\"()\u3001\u3002\uFF01\uFF1F\uFF0C\uFF0E";
  return kMarks.find(c) != std::u32string_view::npos;
}

}  // namespace

bool IsUnspaced(char32_t c) {
  return (c >= 0x2E80 && c <= 0xD7FF) || (c >= 0xF900 && c <= 0xFAFF) ||
         (c >= 0xFF00 && c <= 0xFFEF) || (c >= 0x20000 && c <= 0x3FFFF);
}

char32_t DecodeBefore(std::string_view text, std::size_t end) {
  if (end == 0) return 0;
  std::size_t start = end - 1;
  while (start > 0 && end - start < 4 && !vm::BeginsSign(text[start])) --start;
  return vm::SignAt(text, start).value;
}

std::string Fold(std::string_view text) {
  std::vector<std::u32string> words(1);
  const bool ascii = std::ranges::all_of(text, [](char c) { return (c & 0x80) == 0; });
  for (const char32_t sign : vm::SignsOf(ascii ? text : WithoutCase(text))) {
    const char32_t c = Plain(sign);
    if (c == U' ' || (c >= U'\t' && c <= U'\r')) {
      if (!words.back().empty()) words.emplace_back();
    } else {
      words.back() += c;
    }
  }
  std::string folded;
  for (std::u32string& word : words) {
    std::size_t begin = 0;
    std::size_t end = word.size();
    while (end > begin && IsPunctuation(word[end - 1])) --end;
    while (begin < end && IsPunctuation(word[begin])) ++begin;
    if (begin == end) {  // nothing but punctuation: it stands for itself if it is all there is
      if (words.size() > 1 || word.empty()) continue;
      begin = 0;
      end = word.size();
    }
    if (!folded.empty()) folded += ' ';
    for (std::size_t i = begin; i < end; ++i) vm::AppendUtf8(folded, word[i]);
  }
  return folded;
}

std::string FoldKeys(std::string_view folded) {
  std::string keys;
  while (!folded.empty()) {
    const std::string_view word = folded.substr(0, folded.find(' '));
    folded.remove_prefix(std::min(word.size() + 1, folded.size()));
    if (word == "star") {
      keys += '*';
    } else if (word == "pound") {
      keys += '#';
    } else {
      keys += word;
    }
  }
  return keys;
}

}  // namespace vxml::srgs
