#pragma once

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "vm_protocol/core/blanks.h"

namespace chat {

/// What the readable tables of this module have in common. Pure.

/// The pieces between any of `signs`, trimmed; empty ones are left out.
inline std::vector<std::string_view> SplitAt(std::string_view text, std::string_view signs) {
  std::vector<std::string_view> pieces;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find_first_of(signs), text.size());
    if (const auto piece = vm::Trimmed(text.substr(0, end)); !piece.empty())
      pieces.push_back(piece);
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return pieces;
}

/// A line of a table that says something: neither blank nor a comment (#).
struct TableLine {
  std::string_view text;
  std::size_t number = 0;
};
inline std::vector<TableLine> TableLines(std::string_view text) {
  std::vector<TableLine> lines;
  for (std::size_t number = 1; !text.empty(); ++number) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = vm::Trimmed(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
    if (!line.empty() && line.front() != '#') lines.push_back({line, number});
  }
  return lines;
}

inline std::string Place(const std::string& file, std::size_t line) {
  return file + ":" + std::to_string(line) + ": ";
}

/// The text with Latin small letters made capitals.
inline std::string UpperCase(std::string_view text) {
  std::string upper(text);
  for (char& c : upper) c = static_cast<char>(c >= 'a' && c <= 'z' ? c - 32 : c);
  return upper;
}

}  // namespace chat
