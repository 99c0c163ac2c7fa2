#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

namespace gateway {

/// A slot as a tool of MCP. A plain value.
struct SlotTool {
  std::string module, slot;
  std::string help{};     ///< without the grammar
  std::string grammar{};  ///< of its value; empty where it cannot be set
  bool readable = false, writable = false;

  /// "FSM_FaceExp": what stands for it among tools; 64 letters, digits, _ and - at most.
  std::string Name() const;
  /// What tools/list says of it. A value that can be chosen, or is a number, has its bounds; any
  /// other is a text with its grammar in words. Of a slot that can be set and asked the value may
  /// be left out: then it is asked.
  nlohmann::json Description() const;
};

/// From a module's answers to `inq SLOT.help` and `inq SLOT.prop`.
SlotTool MakeSlotTool(std::string module, std::string slot, std::string_view help,
                      std::string_view attributes);

/// The JSON schema of values of a grammar (docs/protocol.md, Values).
nlohmann::json SchemaOf(const std::string& grammar);

/// `text` as `pattern` has it, where each * stands for any letters. Case does not count.
bool MatchesPattern(std::string_view pattern, std::string_view text);

}  // namespace gateway
