#include "hypermask/base/key_lines.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <optional>

namespace hypermask {
namespace {

std::vector<std::string_view> Words(std::string_view line) {
  constexpr std::string_view kBlanks = " \t\r";
  std::vector<std::string_view> words;
  line = line.substr(0, line.find('#'));
  while (true) {
    const std::size_t begin = line.find_first_not_of(kBlanks);
    if (begin == std::string_view::npos) return words;
    const std::size_t end = line.find_first_of(kBlanks, begin);
    words.push_back(line.substr(begin, end - begin));
    if (end == std::string_view::npos) return words;
    line.remove_prefix(end);
  }
}

std::optional<double> Number(std::string_view word) {
  constexpr double kMost = 1e9;
  double value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || end != word.data() + word.size()) return std::nullopt;
  if (!std::isfinite(value) || std::abs(value) > kMost) return std::nullopt;
  return value;
}

/// A word as it may be shown in an error.
std::string Shown(std::string_view word) {
  constexpr std::size_t kMost = 40;
  std::string shown;
  for (const char c : word.substr(0, kMost)) shown += c >= ' ' && c <= '~' ? c : '?';
  return shown + (word.size() > kMost ? "..." : "");
}

std::string KeyNames(const KeyLineFormat& format) {
  std::string names;
  for (const auto& [name, key] : format.keys) names += (names.empty() ? "" : ", ") + name;
  return names;
}

}  // namespace

vm::Result<void> ReadKeyLines(const std::string& name, std::string_view text,
                              const KeyLineFormat& format) {
  std::size_t line_number = 0;
  const auto wrong = [&](const std::string& what) {
    return vm::Fail(vm::Errc::kBadValue, fmt::format("{}:{}: {}", name, line_number, what));
  };
  std::map<std::string, std::size_t, std::less<>> seen;
  bool heading = false;
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    std::string_view line = text.substr(0, end);
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    ++line_number;
    if (!heading) {
      if (line.ends_with('\r')) line.remove_suffix(1);
      if (line != format.heading) {
        return wrong(
            fmt::format("found '{}', expected the heading '{}'", Shown(line), format.heading));
      }
      heading = true;
      continue;
    }
    const auto words = Words(line);
    if (words.empty()) continue;
    const auto key = format.keys.find(words[0]);
    if (key == format.keys.end()) {
      return wrong(
          fmt::format("found '{}', expected one of: {}", Shown(words[0]), KeyNames(format)));
    }
    if (++seen[key->first] > key->second.most) {
      return wrong(
          fmt::format("one '{}' too many, expected at most {}", key->first, key->second.most));
    }
    if (words.size() - 1 != key->second.numbers) {
      return wrong(fmt::format("{} numbers follow '{}', expected {}", words.size() - 1, key->first,
                               key->second.numbers));
    }
    std::vector<double> numbers;
    for (std::size_t i = 1; i < words.size(); ++i) {
      const auto number = Number(words[i]);
      if (!number) {
        return wrong(fmt::format("found '{}', expected a number within +-1e9", Shown(words[i])));
      }
      numbers.push_back(*number);
    }
    if (const std::string problem = key->second.take(numbers); !problem.empty()) {
      return wrong(fmt::format("'{}': {}", key->first, problem));
    }
  }
  if (!heading) {
    line_number = 1;
    return wrong(fmt::format("the file is empty, expected the heading '{}'", format.heading));
  }
  for (const auto& [key, spec] : format.keys) {
    const auto count = seen.find(key);
    const std::size_t lines = count == seen.end() ? 0 : count->second;
    if (lines < spec.least) {
      return wrong(fmt::format("the file ends with {} lines '{}', expected at least {}", lines, key,
                               spec.least));
    }
  }
  return {};
}

}  // namespace hypermask
