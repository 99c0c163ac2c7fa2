#include "task_manager/grammar/text.h"

#include <algorithm>
#include <vector>

namespace vxml::srgs {
namespace {

char32_t Lower(char32_t c) {
  if (c >= U'A' && c <= U'Z') return c + 32;
  if ((c >= 0xC0 && c <= 0xDE && c != 0xD7) || (c >= 0x391 && c <= 0x3A9)) return c + 32;
  if (c >= 0x410 && c <= 0x42F) return c + 32;
  if (c >= 0x400 && c <= 0x40F) return c + 80;
  if (c >= 0xFF21 && c <= 0xFF3A) return c - 0xFF21 + U'a';  // full-width letters
  if (c >= 0xFF41 && c <= 0xFF5A) return c - 0xFF41 + U'a';
  if (c >= 0xFF10 && c <= 0xFF19) return c - 0xFF10 + U'0';  // full-width digits
  if (c == 0x3000 || c == 0xA0) return U' ';
  if (c == 0x2019) return U'\'';
  if (c >= 0x100 && c <= 0x17F && (c % 2) == 0) return c + 1;
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
  for (const char32_t sign : vm::SignsOf(text)) {
    const char32_t c = Lower(sign);
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
