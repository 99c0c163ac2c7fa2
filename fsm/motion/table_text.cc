#include "fsm/motion/table_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "vm_protocol/core/utf8.h"

namespace fsm {

TableText::TableText(std::string name, std::string_view text) : name_(std::move(name)) {
  int number = 0;
  while (!text.empty()) {
    ++number;
    const std::size_t newline = text.find('\n');
    std::string_view line = text.substr(0, newline);
    text.remove_prefix(newline == std::string_view::npos ? text.size() : newline + 1);
    TableLine out{number, {}};
    while (true) {
      const std::size_t begin = line.find_first_not_of(" \t\r");
      if (begin == std::string_view::npos || line[begin] == '#') break;
      const std::size_t end = std::min(line.find_first_of(" \t\r", begin), line.size());
      out.words.emplace_back(line.substr(begin, end - begin));
      line.remove_prefix(end);
    }
    if (!out.words.empty()) lines_.push_back(std::move(out));
  }
}

std::unexpected<vm::Error> TableText::Wrong(int line, const std::string& text) const {
  // What stands in a damaged file is shown, but not all of a very long word and no control bytes.
  constexpr std::size_t kShown = 400;
  std::string shown = text.size() <= kShown ? text
                                            : text.substr(0, kShown / 2) + "..." +
                                                  text.substr(text.size() - kShown / 2);
  for (char& c : shown) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = '?';
  }
  // Shortening may cut a character of several bytes.
  while (const auto bad = vm::FirstBadUtf8(shown)) shown[*bad] = '?';
  if (line == 0) return vm::Fail(vm::Errc::kBadValue, fmt::format("{}: {}", name_, shown));
  return vm::Fail(vm::Errc::kBadValue, fmt::format("{}:{}: {}", name_, line, shown));
}

vm::Result<double> TableText::Number(const TableLine& line, std::size_t word,
                                     const std::string& what, double lowest, double highest) const {
  if (word >= line.words.size()) {
    return Wrong(line.number, fmt::format("the line ends where {} is expected", what));
  }
  const auto number = ParseNumber(line.words[word]);
  if (!number || *number < lowest || *number > highest) {
    return Wrong(line.number, fmt::format("'{}' found, {} expected, a number from {:g} to {:g}",
                                          line.words[word], what, lowest, highest));
  }
  return *number;
}

vm::Result<void> TableText::Name(const TableLine& line, std::size_t word,
                                 const std::string& what) const {
  constexpr std::size_t kLongest = 40;
  const std::string& name = line.words[word];
  const auto letter = [](char c) { return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z'); };
  const bool good =
      name.size() <= kLongest && letter(name[0]) && std::ranges::all_of(name, [&](char c) {
        return letter(c) || (c >= '0' && c <= '9') || c == '_';
      });
  if (good) return {};
  return Wrong(line.number, fmt::format("'{}' found, {} expected: a letter, then letters, digits "
                                        "and _, at most {}",
                                        name.substr(0, kLongest), what, kLongest));
}

vm::Result<std::string> ReadTableFile(const std::string& path) {
  std::error_code code;
  std::ifstream in;
  // Devices and pipes are left alone: they may never end.
  if (std::filesystem::is_regular_file(path, code)) in.open(path, std::ios::binary);
  if (!in.is_open()) return vm::Fail(vm::Errc::kUnavailable, "cannot read " + path);
  std::string text(kMaxTableBytes + 1, '\0');
  in.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (in.bad()) return vm::Fail(vm::Errc::kUnavailable, "cannot read " + path);
  text.resize(static_cast<std::size_t>(in.gcount()));
  if (text.size() > kMaxTableBytes) {
    return vm::Fail(vm::Errc::kLimit,
                    fmt::format("{} is longer than {} bytes, no table", path, kMaxTableBytes));
  }
  return text;
}

vm::Result<void> CheckTableEncoding(const std::string& name, std::string_view text) {
  const auto bad = vm::FirstBadUtf8(text);
  if (!bad) return {};
  const auto line = 1 + std::ranges::count(text.substr(0, *bad), '\n');
  return vm::Fail(vm::Errc::kBadUtf8,
                  fmt::format("{}:{}: a byte that is not UTF-8 found, text expected", name, line));
}

vm::Result<double> ParseNumber(std::string_view word) {
  if (word.starts_with('+')) word.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc{} || end != word.data() + word.size() || !std::isfinite(value)) {
    return vm::Fail(vm::Errc::kBadValue, fmt::format("'{}' is not a number", word));
  }
  return value;
}

}  // namespace fsm
