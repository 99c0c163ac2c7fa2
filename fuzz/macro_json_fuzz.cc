// Macros in JSON, as `def` brings them, and the texts with variables in them.

#include <cstdint>
#include <string>
#include <string_view>

#include "agent_manager/macros/macro.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  if (const auto macro = am::ParseMacro("M", text)) {
    const auto lookup = [](const std::string& name) { return name + name; };
    am::ForEachStep(macro->steps, [&](const am::MacroStep& step) {
      if (const auto* const send = std::get_if<am::SendStep>(&step.action))
        static_cast<void>(send->message.Expand(lookup));
    });
  }
  static_cast<void>(am::ParseMacroFile(text));
  return 0;
}
