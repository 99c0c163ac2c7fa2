#include "srm_stub/input_script.h"

#include <algorithm>
#include <charconv>
#include <utility>

namespace srm_stub {

vm::Result<std::vector<ScriptLine>> ParseScript(std::string_view text) {
  std::vector<ScriptLine> lines;
  for (std::size_t number = 1; !text.empty(); ++number) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    if (line.ends_with('\r')) line.remove_suffix(1);
    line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
    if (line.empty() || line.front() == '#') continue;
    long ms = 0;
    const auto [rest, error] = std::from_chars(line.data(), line.data() + line.size(), ms);
    const std::string_view said = line.substr(static_cast<std::size_t>(rest - line.data()));
    const std::size_t begin = said.find_first_not_of(" \t");
    const std::string where = "line " + std::to_string(number) + " of the script: ";
    const bool blank_between = !said.empty() && (said.front() == ' ' || said.front() == '\t');
    if (error != std::errc() || ms < 0 || ms > 86'400'000 || begin == std::string_view::npos ||
        !blank_between) {
      return vm::Fail(vm::Errc::kSyntax,
                      where + "found '" + std::string(line.substr(0, 40)) + "', expected MS TEXT");
    }
    if (lines.size() == kMaxScriptLines) {
      return vm::Fail(vm::Errc::kLimit,
                      where + "more than " + std::to_string(kMaxScriptLines) + " utterances");
    }
    lines.push_back({std::chrono::milliseconds(ms), std::string(said.substr(begin)), number});
  }
  std::sort(lines.begin(), lines.end(), [](const ScriptLine& a, const ScriptLine& b) {
    return std::pair(a.at, a.number) < std::pair(b.at, b.number);
  });
  return lines;
}

}  // namespace srm_stub
