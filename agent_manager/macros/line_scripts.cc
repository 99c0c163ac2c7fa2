#include "agent_manager/macros/line_scripts.h"

#include <algorithm>
#include <utility>

#include "vm_protocol/core/limits.h"

namespace am {

using vm::Errc;
using vm::Fail;
using vm::Result;

LineScripts::LineScripts(Hub& hub, ReadFile read_file)
    : hub_(hub), read_file_(std::move(read_file)) {}

Result<LineScripts::Script> LineScripts::Parse(std::string_view text, const std::string& where) {
  Script script;
  std::size_t number = 0;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    ++number;
    auto message = vm::ParseMessage(line);
    if (!message && message.error().code == Errc::kEmpty) continue;
    if (!message)
      return Fail(message.error().code,
                  where + " line " + std::to_string(number) + ": " + message.error().text,
                  message.error().column);
    message->from.clear();
    script.lines.push_back(std::move(*message));
    script.bytes += line.size();
    if (script.lines.size() > vm::kMaxMacroLines)
      return Fail(Errc::kLimit,
                  where + " has more than " + std::to_string(vm::kMaxMacroLines) + " lines");
  }
  return script;
}

Result<void> LineScripts::Keep(const std::string& name, Script script) {
  const auto before = scripts_.find(name);
  const std::size_t replaced = before == scripts_.end() ? 0 : before->second.bytes;
  if (before == scripts_.end() && scripts_.size() >= kMaxScripts)
    return Fail(Errc::kLimit, "more than " + std::to_string(kMaxScripts) + " scripts");
  if (bytes_ - replaced + script.bytes > kMaxBytes)
    return Fail(Errc::kLimit, "scripts hold more than " + std::to_string(kMaxBytes) + " bytes");
  bytes_ += script.bytes - replaced;
  scripts_[name] = std::move(script);
  return {};
}

Result<void> LineScripts::Append(const std::string& name, const std::string& line) {
  auto more = Parse(line, "macro '" + name + "'");
  if (!more) return std::unexpected(more.error());
  const auto before = scripts_.find(name);
  Script script = before == scripts_.end() ? Script{} : before->second;
  script.bytes += more->bytes;
  for (vm::Message& message : more->lines) script.lines.push_back(std::move(message));
  if (script.lines.size() > vm::kMaxMacroLines)
    return Fail(Errc::kLimit, "macro '" + name + "' would have more than " +
                                  std::to_string(vm::kMaxMacroLines) + " lines");
  return Keep(name, std::move(script));
}

Result<void> LineScripts::Load(const std::string& name, const std::string& path) {
  const auto text = read_file_(path);
  if (!text) return std::unexpected(text.error());
  auto script = Parse(*text, path);
  if (!script) return std::unexpected(script.error());
  return Keep(name, std::move(*script));
}

void LineScripts::Delete(const std::string& name) {
  const auto found = scripts_.find(name);
  if (found == scripts_.end()) return;
  bytes_ -= found->second.bytes;
  scripts_.erase(found);
}

Result<std::size_t> LineScripts::Do(const std::string& name_or_path, const Origin& origin) {
  if (const auto checked = hub_.CheckCaused(origin, vm::kMaxDoLines); !checked)
    return std::unexpected(checked.error());
  Script from_file;
  const auto kept = scripts_.find(name_or_path);
  if (kept == scripts_.end()) {
    const auto text = read_file_(name_or_path);
    if (!text)
      return Fail(text.error().code,
                  "no macro '" + name_or_path + "', and as a file: " + text.error().text);
    auto parsed = Parse(*text, name_or_path);
    if (!parsed) return std::unexpected(parsed.error());
    from_file = std::move(*parsed);
  }
  const Script& script = kept == scripts_.end() ? from_file : kept->second;
  Origin deeper = origin;
  ++deeper.depth;
  if (!deeper.lines_left) deeper.lines_left = std::make_shared<std::size_t>(vm::kMaxDoLines);
  if (script.lines.size() > *deeper.lines_left)
    return Fail(Errc::kLimit,
                "stopped: one `do` says at most " + std::to_string(vm::kMaxDoLines) + " lines");
  *deeper.lines_left -= script.lines.size();
  for (const vm::Message& line : script.lines) hub_.SayAs(deeper, line);
  return script.lines.size();
}

}  // namespace am
