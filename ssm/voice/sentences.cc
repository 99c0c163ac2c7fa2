#include "ssm/voice/sentences.h"

#include <algorithm>
#include <array>
#include <cctype>

namespace ssm {
namespace {

constexpr std::array<std::string_view, 4> kWideStops = {"。", "！", "？", "．"};
constexpr std::array<std::string_view, 3> kWideBlanksAndQuotes = {"　", "」", "』"};

/// True if the word before the full stop at `stop` is one that takes a full stop by itself.
bool IsTitle(std::string_view text, std::size_t stop) {
  static constexpr std::array<std::string_view, 14> kTitles = {
      "Mr", "Mrs", "Ms", "Dr", "St", "Prof", "Jr", "Sr", "vs", "etc", "No", "e.g", "i.e", "cf"};
  std::size_t begin = stop;
  while (begin > 0 && text[begin - 1] != ' ') --begin;
  const std::string_view word = text.substr(begin, stop - begin);
  return word.size() == 1 || std::ranges::find(kTitles, word) != kTitles.end();
}

template <std::size_t N>
std::size_t LengthOfOne(const std::array<std::string_view, N>& signs, std::string_view text) {
  for (const std::string_view sign : signs) {
    if (text.starts_with(sign)) return sign.size();
  }
  return 0;
}

}  // namespace

bool EndsSentence(std::string_view text, std::size_t at) {
  if (LengthOfOne(kWideStops, text.substr(at)) > 0) return true;
  if (text[at] != '.' && text[at] != '!' && text[at] != '?') return false;
  const std::size_t after = text.find_first_not_of("\"')", at + 1);
  if (after == std::string_view::npos || text[after] != ' ') return false;
  const std::size_t next = text.find_first_not_of(" \"'(", after);
  if (next == std::string_view::npos) return false;
  if (std::islower(static_cast<unsigned char>(text[next])) != 0) return false;
  return !(text[at] == '.' && IsTitle(text, at));
}

std::vector<std::string_view> CutSentences(std::string_view text) {
  std::vector<std::string_view> sentences;
  std::size_t begin = 0;
  for (std::size_t at = 0; at < text.size(); ++at) {
    if (!EndsSentence(text, at)) continue;
    std::size_t end = at + std::max<std::size_t>(1, LengthOfOne(kWideStops, text.substr(at)));
    while (end < text.size()) {
      const std::size_t wide = std::max(LengthOfOne(kWideBlanksAndQuotes, text.substr(end)),
                                        LengthOfOne(kWideStops, text.substr(end)));
      const bool narrow = std::string_view(" \"')").contains(text[end]);
      if (wide == 0 && !narrow) break;
      end += std::max<std::size_t>(1, wide);
    }
    sentences.push_back(text.substr(begin, end - begin));
    begin = end;
    at = end - 1;
  }
  if (begin < text.size()) sentences.push_back(text.substr(begin));
  return sentences;
}

}  // namespace ssm
