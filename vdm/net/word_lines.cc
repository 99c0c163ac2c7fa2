#include "vdm/net/word_lines.h"

#include <algorithm>
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

vm::Result<WordLines::Words> WordLines::Line(std::string_view key, std::size_t count) {
  if (!More()) return Wrong(fmt::format("the end found, '{}' expected", key));
  Words words = std::exchange(words_, {});
  if (words[0] != key) {
    return Wrong(fmt::format("'{}' found, '{}' expected", words[0].substr(0, 40), key));
  }
  if (count != 0 && words.size() != count) {
    return Wrong(
        fmt::format("{} values after '{}' found, {} expected", words.size() - 1, key, count - 1));
  }
  return words;
}

}  // namespace vdm
