#include <algorithm>

#include "ear/grammar/grammar.h"
#include "vm_protocol/core/utf8.h"

namespace ear {
namespace {

bool IsWordByte(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '\'' ||
         c == '-';
}

bool IsWideSign(std::string_view character) {
  static constexpr std::string_view kSigns[] = {"、", "。", "！", "？", "　", "「", "」",
                                                "・", "，", "．", "“",  "”",  "…"};
  return std::find(std::begin(kSigns), std::end(kSigns), character) != std::end(kSigns);
}

}  // namespace

std::vector<std::string> WordsOf(std::string_view text) {
  std::vector<std::string> words;
  for (std::size_t at = 0; at < text.size();) {
    std::string word;
    if (IsWordByte(text[at])) {
      for (; at < text.size() && IsWordByte(text[at]); ++at) {
        const char c = text[at];
        word += c >= 'A' && c <= 'Z' ? static_cast<char>(c + ('a' - 'A')) : c;
      }
      if (word.find_first_not_of("'-") == std::string::npos) word.clear();
    } else if (static_cast<unsigned char>(text[at]) >= 0x80) {
      while (at < text.size() && static_cast<unsigned char>(text[at]) >= 0x80) {
        const auto sign = vm::DecodeUtf8(text, at);
        const std::string_view c = text.substr(at, sign ? sign->length : 1);
        at += c.size();
        if (!sign || IsWideSign(c)) break;  // a byte that is not UTF-8 is no part of a word
        word += c;
      }
    } else {
      ++at;
    }
    if (!word.empty()) words.push_back(std::move(word));
  }
  return words;
}

}  // namespace ear
