#include "vm_protocol/core/nearest_word.h"

#include <algorithm>
#include <numeric>
#include <vector>

#include "vm_protocol/core/lower_case.h"

namespace vm {
namespace {

constexpr std::size_t kMaxChanges = 2;
constexpr std::size_t kMaxWordBytes = 128;  // longer words are not mistyped names

/// Bytes to be changed, put in or left out, or neighbours exchanged (optimal string alignment).
std::size_t Changes(std::string_view a, std::string_view b) {
  std::vector<std::size_t> before(b.size() + 1), above(b.size() + 1), row(b.size() + 1);
  std::iota(above.begin(), above.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      row[j] = std::min({above[j] + 1, row[j - 1] + 1, above[j - 1] + (a[i - 1] != b[j - 1])});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        row[j] = std::min(row[j], before[j - 2] + 1);
    }
    before.swap(above);
    above.swap(row);
  }
  return above[b.size()];
}

}  // namespace

std::string_view NearestWord(std::string_view word, std::span<const std::string> known) {
  if (word.empty() || word.size() > kMaxWordBytes) return {};
  const std::string wanted = LowerCase(word);
  std::string_view nearest, longer;
  std::size_t least = std::min(kMaxChanges, (word.size() - 1) / 2) + 1;
  for (const std::string& candidate : known) {
    const std::string lower = LowerCase(candidate);
    if (longer.empty() && lower.size() > wanted.size() && lower.starts_with(wanted))
      longer = candidate;
    const std::size_t apart =
        lower.size() > wanted.size() ? lower.size() - wanted.size() : wanted.size() - lower.size();
    if (apart >= least) continue;
    if (const std::size_t changes = Changes(wanted, lower); changes < least) {
      least = changes;
      nearest = candidate;
    }
  }
  return nearest.empty() ? longer : nearest;
}

std::string DidYouMean(std::string_view word, std::span<const std::string> known) {
  const std::string_view nearest = NearestWord(word, known);
  return nearest.empty() ? "" : ", did you mean '" + std::string(nearest) + "'?";
}

}  // namespace vm
