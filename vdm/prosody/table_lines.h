#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "vm_protocol/core/result.h"

namespace vdm {

/// The lines of a table with words in them, one after the other; `#` begins a comment.
/// Lifetime: the text outlives it. Errors: kBadValue "NAME:LINE: ..." with what was found and
/// expected; LINE is that of the last line taken.
class TableLines {
 public:
  TableLines(std::string name, std::string_view text) : name_(std::move(name)), text_(text) {}

  /// The words of the next line; none at the end.
  std::vector<std::string_view> Next();
  /// The next line, which begins with `key` and has `count` words behind it.
  vm::Result<std::vector<std::string_view>> Next(std::string_view key, std::size_t count);
  /// Numbers within +-10000 behind `key`.
  vm::Result<std::vector<float>> Numbers(std::string_view key, std::size_t count);
  vm::Result<float> Number(std::string_view word) const;
  std::unexpected<vm::Error> Wrong(const std::string& what) const;

 private:
  const std::string name_;
  const std::string_view text_;
  std::size_t at_ = 0;
  int line_ = 0;
};

/// A number with six digits; what is nothing beside the rest is 0.
std::string NumberText(float value);

}  // namespace vdm
