#include "task_manager/document/emotionml_values.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>

#include "task_manager/document/schema.h"
#include "vm_protocol/xml/node.h"

namespace vxml {

std::optional<double> Number(std::string_view text) {
  text = vm::xml::Trim(text);
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
  double value = 0;
  const auto read = std::from_chars(text.data(), text.data() + text.size(), value);
  if (read.ec != std::errc() || read.ptr != text.data() + text.size() || !std::isfinite(value)) {
    return {};
  }
  return value;
}

bool IsWhole(std::string_view text, bool may_be_negative) {
  text = vm::xml::Trim(text);
  if (text.starts_with('+') || (may_be_negative && text.starts_with('-'))) text.remove_prefix(1);
  return !text.empty() && text.find_first_not_of("0123456789") == std::string_view::npos;
}

namespace {

bool IsLetter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' || (c & 0x80) != 0;
}
bool IsNameSign(char c) { return IsLetter(c) || (c >= '0' && c <= '9') || c == '-' || c == '.'; }
bool IsSchemeSign(char c) { return (c & 0x80) == 0 && c != '_' && (IsNameSign(c) || c == '+'); }
bool IsHex(char c) { return std::string_view("0123456789abcdefABCDEF").contains(c); }

}  // namespace

bool IsId(std::string_view text) {
  return !text.empty() && IsLetter(text[0]) && std::ranges::all_of(text, IsNameSign);
}

bool IsToken(std::string_view text) {
  return !text.empty() &&
         std::ranges::all_of(text, [](char c) { return IsNameSign(c) || c == ':'; });
}

bool IsUri(std::string_view text) {
  text = vm::xml::Trim(text);
  if (text.empty()) return false;
  bool fragment = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    const bool allowed = IsNameSign(c) || std::string_view("~:/?[]@!$&'()*+,;=#%").contains(c);
    if (!allowed || (c == '#' && std::exchange(fragment, true))) return false;
    if (c == '%' && (i + 2 >= text.size() || !IsHex(text[i + 1]) || !IsHex(text[i + 2]))) {
      return false;
    }
  }
  // A colon in the first segment ends a scheme.
  const std::string_view segment = text.substr(0, text.find_first_of("/?#"));
  const std::size_t colon = segment.find(':');
  if (colon == std::string_view::npos) return true;
  const std::string_view scheme = segment.substr(0, colon);
  return !scheme.empty() && IsSchemeSign(scheme[0]) && IsLetter(scheme[0]) &&
         std::ranges::all_of(scheme, IsSchemeSign);
}

bool IsMediaType(std::string_view text) {
  const std::string_view type = vm::xml::Trim(text.substr(0, text.find(';')));
  const std::size_t slash = type.find('/');
  if (slash == std::string_view::npos) return false;
  const auto is_part = [](std::string_view part) {
    return !part.empty() && std::ranges::all_of(part, [](char c) {
      return c > ' ' && c < 127 && !std::string_view("()<>@,;:\\\"/[]?=").contains(c);
    });
  };
  return is_part(type.substr(0, slash)) && is_part(type.substr(slash + 1));
}

}  // namespace vxml
