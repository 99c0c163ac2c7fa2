#include "ssm/voice/word_places.h"

#include <utf8proc.h>

#include <algorithm>

#include "vm_protocol/core/utf8.h"

namespace ssm {
namespace {

/// How many letters are passed over at most to find a word.
constexpr std::size_t kLookahead = 40;

struct Sign {
  char32_t folded;
  std::size_t begin, end;  // bytes
  bool spaced = false;     // of a script that parts words by blanks
};

char32_t Folded(char32_t c) {
  if (c >= 0xFF01 && c <= 0xFF5E) c -= 0xFEE0;
  return static_cast<char32_t>(utf8proc_tolower(static_cast<utf8proc_int32_t>(c)));
}

bool IsOfWord(char32_t c) {
  const utf8proc_category_t kind = utf8proc_category(static_cast<utf8proc_int32_t>(c));
  return (kind >= UTF8PROC_CATEGORY_LU && kind <= UTF8PROC_CATEGORY_NO) ||
         kind == UTF8PROC_CATEGORY_SC || c == U'%' || c == U'&' || c == U'@' || c == U'+';
}

bool IsSpaced(char32_t c) { return c < 0x2E80; }

/// The letters and figures of a text; what is between them only shows in the bytes.
std::vector<Sign> LettersOf(std::string_view text) {
  std::vector<Sign> letters;
  for (std::size_t at = 0; at < text.size();) {
    const vm::CodePoint c = vm::SignAt(text, at);
    const char32_t folded = Folded(c.value);
    if (IsOfWord(folded)) letters.push_back({folded, at, at + c.length, IsSpaced(folded)});
    at += c.length;
  }
  return letters;
}

bool BeginsToken(const std::vector<Sign>& letters, std::size_t i) {
  return i == 0 || letters[i].begin > letters[i - 1].end || !letters[i].spaced ||
         !letters[i - 1].spaced;
}

}  // namespace

Millis WordPlaces::Place::At(std::size_t byte) const {
  if (end <= begin) return start;
  const auto done = static_cast<std::int64_t>(byte - begin);
  return start + (stop - start) * done / static_cast<std::int64_t>(end - begin);
}

WordPlaces::WordPlaces(std::string_view text, const std::vector<WordTime>& words) {
  const std::vector<Sign> letters = LettersOf(text);
  struct Found {
    std::size_t first, last;  // letters [first, last)
    std::size_t word;
  };
  std::vector<Found> found;
  std::size_t cursor = 0;
  for (std::size_t w = 0; w < words.size(); ++w) {
    const std::vector<Sign> wanted = LettersOf(words[w].text);
    if (wanted.empty()) continue;
    const std::size_t limit = std::min(letters.size(), cursor + kLookahead);
    for (std::size_t i = cursor; i < limit && i + wanted.size() <= letters.size(); ++i) {
      if (i != cursor && !BeginsToken(letters, i)) continue;
      const bool same =
          std::equal(wanted.begin(), wanted.end(), letters.begin() + static_cast<std::ptrdiff_t>(i),
                     [](const Sign& a, const Sign& b) { return a.folded == b.folded; });
      const std::size_t end = i + wanted.size();
      if (!same || (end < letters.size() && !BeginsToken(letters, end))) continue;
      found.push_back({i, end, w});
      cursor = end;
      break;
    }
  }
  // What lies between two found words belongs to the words between them, token by token.
  const auto fill = [&](std::size_t first, std::size_t last, std::size_t word, std::size_t end) {
    if (first == last || word == end) return;
    std::vector<std::size_t> tokens;
    for (std::size_t i = first; i < last; ++i) {
      if (i == first || BeginsToken(letters, i)) tokens.push_back(i);
    }
    const std::size_t count = std::min(tokens.size(), end - word);
    tokens.push_back(last);
    const std::size_t parts = tokens.size() - 1;
    for (std::size_t k = 0; k < count; ++k) {
      const std::size_t from = tokens[k * parts / count], to = tokens[(k + 1) * parts / count];
      const std::size_t begin_word = word + k * (end - word) / count;
      const std::size_t end_word = word + (k + 1) * (end - word) / count;
      places_.push_back({letters[from].begin, letters[to - 1].end, words[begin_word].start,
                         words[end_word - 1].end});
    }
  };
  std::size_t letter = 0, word = 0;
  for (const Found& one : found) {
    fill(letter, one.first, word, one.word);
    places_.push_back({letters[one.first].begin, letters[one.last - 1].end, words[one.word].start,
                       words[one.word].end});
    letter = one.last;
    word = one.word + 1;
  }
  fill(letter, letters.size(), word, words.size());
}

std::optional<Millis> WordPlaces::Begin(std::size_t at) const {
  const auto place = std::ranges::find_if(places_, [at](const Place& p) { return p.end > at; });
  if (place == places_.end()) return std::nullopt;
  return place->begin >= at ? place->start : place->At(at);
}

std::optional<Millis> WordPlaces::End(std::size_t at) const {
  std::optional<Millis> end;
  for (const Place& place : places_) {
    if (place.begin >= at) break;
    end = place.end <= at ? place.stop : place.At(at);
  }
  return end;
}

}  // namespace ssm
