#include "task_manager/platform/json_line.h"

#include <array>
#include <charconv>
#include <cmath>

namespace vxml {

std::string JsonQuote(std::string_view text) {
  static constexpr std::string_view kHex = "0123456789abcdef";
  std::string out = "\"";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    switch (c) {
      case '"':
        out += "\\\"";
        break;
      case '\\':
        out += "\\\\";
        break;
      case '\n':
        out += "\\n";
        break;
      case '\t':
        out += "\\t";
        break;
      case '\r':
        out += "\\r";
        break;
      default:
        if (byte < 0x20 || byte == 0x7F) {
          out += "\\u00";
          out += kHex[byte / 16];
          out += kHex[byte % 16];
        } else {
          out += c;
        }
    }
  }
  return out + "\"";
}

void JsonLine::Name(std::string_view name) {
  if (!fields_.empty()) fields_ += ",";
  fields_ += JsonQuote(name) + ":";
}
JsonLine& JsonLine::Text(std::string_view name, std::string_view value) {
  Name(name);
  fields_ += JsonQuote(value);
  return *this;
}
JsonLine& JsonLine::Number(std::string_view name, double value) {
  Name(name);
  std::array<char, 40> digits{};
  if (!std::isfinite(value)) {
    fields_ += "null";
    return *this;
  }
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
  fields_.append(digits.data(), end);
  return *this;
}
JsonLine& JsonLine::Bool(std::string_view name, bool value) {
  Name(name);
  fields_ += value ? "true" : "false";
  return *this;
}
JsonLine& JsonLine::Raw(std::string_view name, std::string_view json) {
  Name(name);
  fields_ += json == "undefined" ? "null" : json;
  return *this;
}

}  // namespace vxml
