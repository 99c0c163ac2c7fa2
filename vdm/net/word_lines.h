#pragma once

#include <fmt/format.h>

#include <charconv>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "vm_protocol/core/result.h"

namespace vdm {

/// Reads a text of lines of words: words between blanks, the first of them a key, a word
/// that begins with `#` and what follows it is a comment, lines without words are passed over.
/// Errors are kBadValue "NAME:LINE: ...". The text outlives it.
class WordLines {
 public:
  using Words = std::vector<std::string_view>;

  WordLines(std::string name, std::string_view text) : name_(std::move(name)), text_(text) {}

  /// Moves to the next line with words in it; false at the end.
  bool More();
  /// The key of that line; empty at the end.
  std::string_view Key() { return More() ? words_[0] : std::string_view{}; }
  /// The words of the next line; none at the end.
  Words Next();
  /// The words of the next line, which must begin with `key` and have so many behind it, if it is
  /// said how many.
  vm::Result<Words> Line(std::string_view key, std::optional<std::size_t> values = {});
  /// The numbers of such a line, within +-kMost.
  vm::Result<std::vector<float>> Numbers(std::string_view key, std::size_t values);
  vm::Result<float> Number(std::string_view word) const { return Value(word, -kMost, kMost); }
  std::unexpected<vm::Error> Wrong(const std::string& what) const {
    return vm::Fail(vm::Errc::kBadValue, fmt::format("{}:{}: {}", name_, line_, what));
  }
  template <typename T>
  vm::Result<T> Value(std::string_view word, T lowest, T highest) const {
    T value{};
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || end != word.data() + word.size() || !(value >= lowest) ||
        !(value <= highest)) {
      return Wrong(fmt::format("'{}' found, a number from {} to {} expected", word.substr(0, 40),
                               lowest, highest));
    }
    return value;
  }

 private:
  static constexpr float kMost = 10'000;

  const std::string name_;
  const std::string_view text_;
  std::size_t at_ = 0;
  int line_ = 0;
  Words words_;  // of the line in hand that nobody has taken yet
};

/// A number with six digits; what is nothing beside the rest is 0.
std::string NumberText(float value);

}  // namespace vdm
