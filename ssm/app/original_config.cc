#include "ssm/app/original_config.h"

#include <algorithm>
#include <array>
#include <cstdlib>

#include "vm_protocol/core/blanks.h"

namespace ssm {
namespace {

constexpr std::array<std::string_view, 18> kWithoutMeaning = {
    "CHASEN",         "CHASEN-DLL",     "CHASEN-RC",      "CHAONE",        "CHAONE-XSL-FILE",
    "NUMBER",         "ALPHABET",       "DATE",           "TIME",          "DICTIONARY",
    "PHONEME-LIST",   "AUDIODEV",       "DUR-TREE-FILE",  "PIT-TREE-FILE", "MCEP-TREE-FILE",
    "DUR-MODEL-FILE", "PIT-MODEL-FILE", "MCEP-MODEL-FILE"};

vm::Error At(std::size_t line, vm::Errc code, const std::string& text) {
  return {code, "line " + std::to_string(line) + ": " + text, 0};
}

}  // namespace

vm::Result<OriginalConfig> ParseOriginalConfig(std::string_view text) {
  OriginalConfig config;
  std::vector<std::string_view> ignored;
  std::size_t number = 0;
  while (!text.empty()) {
    ++number;
    const std::size_t end = std::min(text.find('\n'), text.size());
    std::string_view line = vm::Trimmed(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
    if (line.empty() || line.front() == '#') continue;
    const std::size_t colon = line.find(':');
    if (colon == std::string_view::npos) {
      return std::unexpected(
          At(number, vm::Errc::kSyntax, "found '" + std::string(line) + "', expected KEY: value"));
    }
    const std::string key(vm::Trimmed(line.substr(0, colon)));
    const std::string value(vm::Trimmed(line.substr(colon + 1)));
    const auto bad = [&](const char* expected) {
      std::string what = key;
      what.append(" is '").append(value).append("', expected ").append(expected);
      return std::unexpected(At(number, vm::Errc::kBadValue, what));
    };
    if (key == "SPEAKER-ID") {
      if (value.empty() || value.find_first_of(" \t") != std::string::npos) return bad("one word");
      config.speakers.push_back({value, false});
    } else if (key == "GENDER") {
      if (value != "male" && value != "female") return bad("male or female");
      if (config.speakers.empty()) return bad("a SPEAKER-ID before it");
      config.speakers.back().female = value == "female";
    } else if (key == "AUTO-PLAY") {
      if (value != "YES" && value != "NO") return bad("YES or NO");
      config.auto_play = value == "YES";
    } else if (key == "AUTO-PLAY-DELAY") {
      char* rest = nullptr;
      const long ms = std::strtol(value.c_str(), &rest, 10);
      if (value.empty() || *rest != '\0' || ms < 0 || ms > 86'400'000) return bad("a number of ms");
      config.auto_play_delay = Millis(ms);
    } else if (const auto known = std::find(kWithoutMeaning.begin(), kWithoutMeaning.end(), key);
               known != kWithoutMeaning.end()) {
      if (std::find(ignored.begin(), ignored.end(), *known) == ignored.end()) {
        ignored.push_back(*known);
      }
    } else {
      return std::unexpected(At(number, vm::Errc::kUnknownSlot, "unknown key '" + key + "'"));
    }
  }
  for (const std::string_view key : ignored) {
    config.notice +=
        (config.notice.empty() ? "without meaning for this engine: " : ", ") + std::string(key);
  }
  return config;
}

}  // namespace ssm
