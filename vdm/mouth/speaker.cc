#include "vdm/mouth/speaker.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "embedded/vowels.h"
#include "vm_protocol/core/text_file.h"

namespace vdm {
namespace {

constexpr float kLeastWarp = 0.5F, kMostWarp = 1.5F;
constexpr std::size_t kMostWarps = 32, kMostNameLength = 40, kMostBytes = 4096;

std::unexpected<vm::Error> Wrong(const std::string& name, int line, const std::string& what) {
  return vm::Fail(vm::Errc::kBadValue, fmt::format("{}:{}: {}", name, line, what));
}

bool ReadWarp(const std::string& word, float& warp) {
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), warp);
  return error == std::errc() && end == word.data() + word.size() && warp >= kLeastWarp &&
         warp <= kMostWarp;
}

/// Calls `take(line number, words)` for each line with words, comments cut off.
template <typename Take>
vm::Result<void> EachLine(std::string_view text, Take take) {
  std::istringstream lines{std::string(text)};
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    std::istringstream in(line.substr(0, line.find('#')));
    std::vector<std::string> words;
    for (std::string word; in >> word;) words.push_back(word);
    if (words.empty()) continue;
    if (auto taken = take(number, words); !taken) return taken;
  }
  return {};
}

}  // namespace

vm::Result<Speaker> ParseSpeaker(const std::string& name, std::string_view text) {
  Speaker speaker;
  bool found = false;
  auto read =
      EachLine(text, [&](int line, const std::vector<std::string>& words) -> vm::Result<void> {
        if (found || words.size() != 2 || words[0] != "warp" || !ReadWarp(words[1], speaker.warp)) {
          return Wrong(name, line,
                       "'" + words[0].substr(0, 40) +
                           "' found, one line 'warp NUMBER' with 0.5 to 1.5 expected");
        }
        found = true;
        return {};
      });
  if (!read) return std::unexpected(read.error());
  if (!found) return Wrong(name, 1, "the end found, 'warp NUMBER' expected");
  return speaker;
}

std::string FormatSpeaker(const Speaker& speaker) {
  return fmt::format("# A speaker of vdm (docs/vdm.md).\nwarp {:.2f}\n", speaker.warp);
}

vm::Result<VowelTable> ReadVowels(const std::string& name, std::string_view text) {
  VowelTable table;
  auto read =
      EachLine(text, [&](int line, const std::vector<std::string>& words) -> vm::Result<void> {
        if (words[0] == "vowels" && table.vowels.empty() && words.size() > 1) {
          table.vowels.assign(words.begin() + 1, words.end());
          return {};
        }
        if (words[0] != "warps" || !table.warps.empty() || words.size() < 2 ||
            words.size() > kMostWarps + 1) {
          return Wrong(name, line, "one line 'vowels CLASS...' and one 'warps NUMBER...' expected");
        }
        for (std::size_t i = 1; i < words.size(); ++i) {
          float warp = 0;
          if (!ReadWarp(words[i], warp) || (i > 1 && warp <= table.warps.back())) {
            return Wrong(name, line,
                         "'" + words[i] + "' found, rising numbers from 0.5 to 1.5 expected");
          }
          table.warps.push_back(warp);
        }
        return {};
      });
  if (!read) return std::unexpected(read.error());
  if (table.vowels.empty() || table.warps.empty()) {
    return Wrong(name, 1, "one line 'vowels CLASS...' and one 'warps NUMBER...' expected");
  }
  return table;
}

const VowelTable& BuiltVowels() {
  static const VowelTable table = [] {
    auto read = ReadVowels("vowels.txt", embedded::vowels());
    if (!read) throw std::runtime_error(read.error().text);
    return std::move(*read);
  }();
  return table;
}

bool SpeakerStore::IsName(std::string_view name) {
  return !name.empty() && name.size() <= kMostNameLength && std::ranges::all_of(name, [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' ||
           c == '_';
  });
}

namespace {

vm::Result<void> CheckName(const std::string& name) {
  if (SpeakerStore::IsName(name)) return {};
  return vm::Fail(vm::Errc::kBadValue, "'" + name.substr(0, 60) +
                                           "' found, a name of 1 to 40 letters, digits, - and _ "
                                           "expected");
}

}  // namespace

vm::Result<Speaker> SpeakerStore::Find(const std::string& name) const {
  if (auto right = CheckName(name); !right) return std::unexpected(right.error());
  if (const auto here = here_.find(name); here != here_.end()) return here->second;
  std::error_code error;
  if (folder_.empty() || !std::filesystem::exists(PathOf(name), error)) {
    return vm::Fail(vm::Errc::kUnavailable, "there is no speaker '" + name + "'");
  }
  auto text = vm::ReadTextFile(PathOf(name), kMostBytes);
  if (!text) return std::unexpected(text.error());
  return ParseSpeaker(PathOf(name), *text);
}

vm::Result<void> SpeakerStore::Keep(const std::string& name, const Speaker& speaker) {
  if (auto right = CheckName(name); !right) return right;
  if (folder_.empty()) {
    if (here_.size() == kMost && !here_.contains(name)) {
      return vm::Fail(vm::Errc::kUnavailable, fmt::format("{} speakers are known already", kMost));
    }
    here_[name] = speaker;
    return {};
  }
  return vm::WriteTextFile(PathOf(name), FormatSpeaker(speaker));
}

}  // namespace vdm
