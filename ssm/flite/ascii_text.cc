#include "ssm/flite/ascii_text.h"

#include <algorithm>
#include <array>
#include <cctype>

#include "ssm/voice/sentences.h"
#include "vm_protocol/core/utf8.h"

namespace ssm {
namespace {

struct Spelling {
  char32_t sign;
  std::string_view ascii;
};

constexpr Spelling kSpellings[] = {
    {0x00A0, " "},   {0x00A3, " pounds "}, {0x00A5, " yen "}, {0x00B0, " degrees "}, {0x00D7, "x"},
    {0x00DF, "ss"},  {0x00C6, "Ae"},       {0x00E6, "ae"},    {0x00D8, "O"},         {0x00F8, "o"},
    {0x0152, "Oe"},  {0x0153, "oe"},       {0x2010, "-"},     {0x2011, "-"},         {0x2013, ", "},
    {0x2014, ", "},  {0x2018, "'"},        {0x2019, "'"},     {0x201C, "\""},        {0x201D, "\""},
    {0x2026, "..."}, {0x20AC, " euros "},  {0x3000, " "},     {0x3001, ", "},        {0x3002, ". "},
    {0x00AB, "\""},  {0x00BB, "\""}};

// U+00C0 to U+00FF without their accents; a blank for those in the table above.
constexpr std::string_view kLatin1 =
    "AAAAAA CEEEEIIIIDNOOOOO  UUUUYT aaaaaa ceeeeiiiidnooooo  uuuuyty";
static_assert(kLatin1.size() == 64);

}  // namespace

AsciiText ToAscii(std::string_view utf8) {
  constexpr std::size_t kNamed = 30;  // bytes of characters left out that are named
  AsciiText result;
  std::size_t word = 0;
  const auto put = [&](std::string_view ascii) {
    for (const char c : ascii) {
      word = c == ' ' ? 0 : word + 1;
      if (word > kMaxWordBytes) {
        result.text += ' ';
        word = 1;
      }
      result.text += c;
    }
  };
  while (!utf8.empty()) {
    const auto [code, bytes] = vm::SignAt(utf8, 0);
    const std::string_view written = utf8.substr(0, bytes);
    utf8.remove_prefix(bytes);
    const auto spelling = std::find_if(std::begin(kSpellings), std::end(kSpellings),
                                       [code](const Spelling& s) { return s.sign == code; });
    if (code < 0x80) {
      const bool printable = code >= 0x20 && code != 0x7F;
      put(printable ? written : " ");
    } else if (spelling != std::end(kSpellings)) {
      put(spelling->ascii);
    } else if (code >= 0xC0 && code <= 0xFF) {
      put(kLatin1.substr(code - 0xC0, 1));
    } else if (code >= 0xFF01 && code <= 0xFF5E) {
      const char half = static_cast<char>(code - 0xFF01 + '!');
      put({&half, 1});
    } else {
      put(" ");
      if (result.left_out.size() < kNamed) result.left_out += written;
    }
  }
  return result;
}

std::vector<std::string> SplitSentences(std::string_view ascii) {
  std::vector<std::string> sentences;
  std::size_t begin = 0;
  const auto cut = [&](std::size_t end) {
    const std::string_view piece = ascii.substr(begin, end - begin);
    begin = end;
    // A piece without a letter or digit that the engine could speak joins nothing.
    if (piece.find_first_not_of(' ') != std::string_view::npos) sentences.emplace_back(piece);
  };
  for (std::size_t at = 0; at < ascii.size(); ++at) {
    if (EndsSentence(ascii, at)) {
      cut(ascii.find(' ', at));
      at = begin;  // beyond quotes and brackets that belong to the sentence
    } else if (at - begin >= kMaxSentenceBytes) {
      const std::string_view piece = ascii.substr(begin, at - begin);
      std::size_t where = piece.rfind(", ");
      where = where == std::string_view::npos || where == 0 ? piece.rfind(' ') : where + 1;
      cut(where == std::string_view::npos || where == 0 ? at : begin + where);
    }
  }
  cut(ascii.size());
  return sentences;
}

}  // namespace ssm
