#include "vdm/net/word_lines.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace vdm {

bool WordLines::More() {
  while (words_.empty() && at_ < text_.size()) {
    const std::size_t end = std::min(text_.find('\n', at_), text_.size());
    const std::string_view line = text_.substr(at_, end - at_);
    at_ = end + 1;
    ++line_;
    for (std::size_t i = 0; i < line.size();) {
      const std::size_t first = line.find_first_not_of(" \t\r", i);
      if (first == std::string_view::npos || line[first] == '#') break;
      i = std::min(line.find_first_of(" \t\r", first), line.size());
      words_.push_back(line.substr(first, i - first));
    }
  }
  return !words_.empty();
}

WordLines::Words WordLines::Next() {
  More();
  return std::exchange(words_, {});
}

vm::Result<WordLines::Words> WordLines::Line(std::string_view key,
                                             std::optional<std::size_t> values) {
  Words words = Next();
  if (words.empty()) return Wrong(fmt::format("the end found, '{}' expected", key));
  if (words[0] != key) {
    return Wrong(fmt::format("'{}' found, '{}' expected", words[0].substr(0, 40), key));
  }
  if (values && words.size() != *values + 1) {
    return Wrong(
        fmt::format("{} values after '{}' found, {} expected", words.size() - 1, key, *values));
  }
  return words;
}

vm::Result<std::vector<float>> WordLines::Numbers(std::string_view key, std::size_t values) {
  const auto words = Line(key, values);
  if (!words) return std::unexpected(words.error());
  std::vector<float> numbers;
  for (std::size_t i = 1; i < words->size(); ++i) {
    const auto number = Number((*words)[i]);
    if (!number) return std::unexpected(number.error());
    numbers.push_back(*number);
  }
  return numbers;
}

std::string NumberText(float value) {
  return fmt::format("{:.6g}", std::abs(value) < 1e-6F ? 0 : value);
}

}  // namespace vdm
