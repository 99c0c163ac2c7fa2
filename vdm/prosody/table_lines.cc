#include "vdm/prosody/table_lines.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace vdm {
namespace {
constexpr float kMost = 10'000;
}

std::vector<std::string_view> TableLines::Next() {
  std::vector<std::string_view> words;
  while (words.empty() && at_ < text_.size()) {
    const std::size_t end = std::min(text_.find('\n', at_), text_.size());
    std::string_view line = text_.substr(at_, end - at_);
    at_ = end + 1;
    ++line_;
    line = line.substr(0, line.find('#'));
    for (std::size_t i = 0; i < line.size();) {
      const std::size_t first = line.find_first_not_of(" \t\r", i);
      if (first == std::string_view::npos) break;
      i = std::min(line.find_first_of(" \t\r", first), line.size());
      words.push_back(line.substr(first, i - first));
    }
  }
  return words;
}

vm::Result<std::vector<std::string_view>> TableLines::Next(std::string_view key,
                                                           std::size_t count) {
  auto words = Next();
  if (words.empty()) return Wrong(fmt::format("the end found, '{}' expected", key));
  if (words[0] != key) {
    return Wrong(fmt::format("'{}' found, '{}' expected", words[0].substr(0, 40), key));
  }
  if (words.size() != count + 1) {
    return Wrong(
        fmt::format("{} values after '{}' found, {} expected", words.size() - 1, key, count));
  }
  return words;
}

vm::Result<std::vector<float>> TableLines::Numbers(std::string_view key, std::size_t count) {
  const auto words = Next(key, count);
  if (!words) return std::unexpected(words.error());
  std::vector<float> numbers;
  for (std::size_t i = 1; i < words->size(); ++i) {
    const auto number = Number((*words)[i]);
    if (!number) return std::unexpected(number.error());
    numbers.push_back(*number);
  }
  return numbers;
}

vm::Result<float> TableLines::Number(std::string_view word) const {
  float value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || end != word.data() + word.size() || !(std::abs(value) <= kMost)) {
    return Wrong(fmt::format("'{}' found, a number from {} to {} expected", word.substr(0, 40),
                             -kMost, kMost));
  }
  return value;
}

std::unexpected<vm::Error> TableLines::Wrong(const std::string& what) const {
  return vm::Fail(vm::Errc::kBadValue, fmt::format("{}:{}: {}", name_, line_, what));
}

std::string NumberText(float value) {
  return fmt::format("{:.6g}", std::abs(value) < 1e-6F ? 0 : value);
}

}  // namespace vdm
