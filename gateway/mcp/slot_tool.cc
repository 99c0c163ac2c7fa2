#include "gateway/mcp/slot_tool.h"

#include <algorithm>
#include <charconv>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "vm_protocol/core/lower_case.h"

namespace gateway {
namespace {

using nlohmann::json;

constexpr std::size_t kMaxNameBytes = 64;  // what clients of older revisions take
constexpr std::string_view kGrammarMark = " Value: ", kReadOnlyMark = " (read only)";

std::string_view Trimmed(std::string_view text) {
  while (text.starts_with(' ')) text.remove_prefix(1);
  while (text.ends_with(' ')) text.remove_suffix(1);
  return text;
}

/// The words of `A | B | C`; nothing where anything else stands between.
std::optional<std::vector<std::string>> Choice(std::string_view grammar) {
  std::vector<std::string> words;
  while (true) {
    const std::size_t bar = std::min(grammar.find('|'), grammar.size());
    const std::string_view word = Trimmed(grammar.substr(0, bar));
    if (word.empty() || word.find_first_of(" <>[]().\"") != std::string_view::npos) return {};
    words.emplace_back(word);
    if (bar == grammar.size()) return words;
    grammar.remove_prefix(bar + 1);
  }
}

std::optional<double> NumberAt(std::string_view text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return {};
  return value;
}

/// `<number A..B>`, `<int>` and their like; nothing for any other grammar.
std::optional<json> NumberSchema(std::string_view grammar) {
  if (!grammar.starts_with('<') || grammar.find('>') != grammar.size() - 1) return {};
  grammar = grammar.substr(1, grammar.size() - 2);
  const std::size_t blank = std::min(grammar.find(' '), grammar.size());
  const std::string_view kind = grammar.substr(0, blank);
  if (kind != "number" && kind != "int" && kind != "ms") return {};
  json schema{{"type", kind == "int" ? "integer" : "number"}};
  const std::string_view range = Trimmed(grammar.substr(blank));
  const std::size_t dots = range.find("..");
  if (dots != std::string_view::npos) {
    if (const auto least = NumberAt(range.substr(0, dots))) schema["minimum"] = *least;
    if (const auto most = NumberAt(range.substr(dots + 2))) schema["maximum"] = *most;
  }
  return schema;
}

}  // namespace

std::string SlotTool::Name() const {
  std::string name = module + "_" + slot;
  for (char& c : name) {
    const bool plain = (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
                       c == '_' || c == '-';
    if (!plain) c = '_';
  }
  return name.substr(0, kMaxNameBytes);
}

json SlotTool::Description() const {
  json properties = json::object(), required = json::array();
  std::string text = help;
  if (writable) {
    properties["value"] = SchemaOf(grammar);
    if (readable) {
      text += " Without a value it is asked.";
    } else {
      required.push_back("value");
    }
  }
  return {{"name", Name()},
          {"title", "@" + module + " " + slot},
          {"description", text},
          {"inputSchema",
           {{"type", "object"},
            {"properties", properties},
            {"required", required},
            {"additionalProperties", false}}},
          {"annotations", {{"readOnlyHint", !writable}, {"openWorldHint", false}}}};
}

SlotTool MakeSlotTool(std::string module, std::string slot, std::string_view help,
                      std::string_view attributes) {
  SlotTool tool{.module = std::move(module), .slot = std::move(slot)};
  tool.writable = attributes.find("ReadOnly") == std::string_view::npos;
  tool.readable = attributes.find("WriteOnly") == std::string_view::npos;
  if (const std::size_t at = help.rfind(kGrammarMark);
      tool.writable && at != std::string_view::npos) {
    tool.grammar = help.substr(at + kGrammarMark.size());
    help = help.substr(0, at);
  } else if (help.ends_with(kReadOnlyMark)) {
    help.remove_suffix(kReadOnlyMark.size());
  }
  tool.help = help;
  return tool;
}

json SchemaOf(const std::string& grammar) {
  const std::string_view plain = Trimmed(grammar);
  if (auto words = Choice(plain)) return {{"type", "string"}, {"enum", *words}};
  if (auto number = NumberSchema(plain)) return *number;
  json schema{{"type", "string"}};
  if (plain != "<text>") schema["description"] = "Grammar: " + std::string(plain);
  return schema;
}

bool MatchesPattern(std::string_view pattern, std::string_view text) {
  const std::size_t star = pattern.find('*');
  if (star == std::string_view::npos) return vm::LowerCase(pattern) == vm::LowerCase(text);
  if (text.size() < star ||
      vm::LowerCase(pattern.substr(0, star)) != vm::LowerCase(text.substr(0, star))) {
    return false;
  }
  // The star takes as little as it can; patterns of the command line have few of them.
  for (std::size_t at = star; at <= text.size(); ++at) {
    if (MatchesPattern(pattern.substr(star + 1), text.substr(at))) return true;
  }
  return false;
}

}  // namespace gateway
