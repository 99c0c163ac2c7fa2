#include "task_manager/document/emotionml_values.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "task_manager/document/schema.h"
#include "vm_protocol/xml/node.h"

namespace vxml {

bool Contains(std::string_view list, std::string_view word) {
  const auto words = SplitWords(list);
  return std::find(words.begin(), words.end(), word) != words.end();
}

std::optional<double> Number(std::string_view text) {
  text = vm::xml::Trim(text);
  double value = 0;
  const auto read = std::from_chars(text.data(), text.data() + text.size(), value);
  if (read.ec != std::errc() || read.ptr != text.data() + text.size() || !std::isfinite(value)) {
    return {};
  }
  return value;
}

bool IsWhole(std::string_view text, bool may_be_negative) {
  text = vm::xml::Trim(text);
  if (may_be_negative && text.starts_with("-")) text.remove_prefix(1);
  return !text.empty() && text.find_first_not_of("0123456789") == std::string_view::npos;
}

bool IsId(std::string_view text) {
  const auto letter = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' || (c & 0x80) != 0;
  };
  if (text.empty() || !letter(text[0])) return false;
  return std::all_of(text.begin(), text.end(), [&](char c) {
    return letter(c) || (c >= '0' && c <= '9') || c == '-' || c == '.';
  });
}

}  // namespace vxml
