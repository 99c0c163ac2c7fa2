#include "agent_manager/config/am_conf.h"

#include <algorithm>
#include <array>
#include <sstream>

#include "agent_manager/routing/own_names.h"
#include "vm_protocol/core/blanks.h"
#include "vm_protocol/core/message.h"
#include "vm_protocol/core/utf8.h"

namespace am {
namespace {

constexpr std::array<std::string_view, 4> kPartsOfTheHub{
    own_name::kHub, own_name::kMacros, own_name::kMacrosOfTheOriginal, own_name::kParallel};

/// Takes the first line, without its end and the blanks around it. REQUIRES: text is not empty.
std::string_view TakeLine(std::string_view& text) {
  const std::size_t end = std::min(text.find('\n'), text.size());
  const std::string_view line = vm::Trimmed(text.substr(0, end));
  text.remove_prefix(std::min(end + 1, text.size()));
  return line;
}

bool IsBlankOrComment(std::string_view line) { return line.empty() || line.starts_with('#'); }

/// Takes the word before the next blank, and the blanks.
std::string_view TakeWord(std::string_view& text) {
  const std::size_t end = std::min(text.find_first_of(vm::kBlanks), text.size());
  const std::string_view word = text.substr(0, end);
  text = vm::Trimmed(text.substr(end));
  return word;
}

}  // namespace

bool IsAmConf(std::string_view text) {
  while (!text.empty()) {
    const std::string_view line = TakeLine(text);
    if (IsBlankOrComment(line)) continue;
    return line.starts_with("module:") || line.starts_with("broadcast:");
  }
  return false;
}

vm::Result<Config> ParseAmConf(std::string_view text, const std::string& origin) {
  Config config;
  std::size_t number = 0;
  const auto fault = [&](std::string_view found, const std::string& expected) {
    return vm::Fail(vm::Errc::kBadValue, origin + " line " + std::to_string(number) + ": found '" +
                                             vm::ShownUtf8(vm::CutUtf8(found, 60)) +
                                             "', expected " + expected);
  };
  while (!text.empty()) {
    const std::string_view line = TakeLine(text);
    ++number;
    if (IsBlankOrComment(line)) continue;
    const std::size_t colon = std::min(line.find(':'), line.size());
    const std::string_view key = line.substr(0, colon);
    std::string_view rest = vm::Trimmed(line.substr(std::min(colon + 1, line.size())));
    if (key == "broadcast") {
      while (!rest.empty()) config.broadcast.emplace_back(TakeWord(rest));
      continue;
    }
    if (key != "module") return fault(line, "broadcast: NAME... or module:NAME commands: LINE");
    ModuleConfig module;
    module.name = TakeWord(rest);
    if (!vm::IsModuleName(module.name)) return fault(module.name, "a module's name");
    if (TakeWord(rest) != "commands:" || rest.empty())
      return fault(line, "module:NAME commands: LINE");
    if (std::ranges::find(config.modules, module.name, &ModuleConfig::name) != config.modules.end())
      return fault(module.name, "a name that is not taken yet");
    if (std::ranges::find(kPartsOfTheHub, module.name) != kPartsOfTheHub.end()) {
      config.notes.push_back(origin + " line " + std::to_string(number) + ": @" + module.name +
                             " is a part of this hub, its program is not started");
      continue;
    }
    module.command = {"/bin/sh", "-c", std::string(rest)};
    config.modules.push_back(std::move(module));
  }
  return config;
}

}  // namespace am
