#include "agent_manager/macros/speak.h"

#include <string>

#include "embedded/built_in_macros.h"

namespace am {

std::string_view BuiltInMacros() { return embedded::built_in_macros(); }

void ReadEmotion(Variables& variables) {
  constexpr std::string_view kEnd = "</emotion>";
  const std::string text = variables["text"];
  if (!text.starts_with("<emotion ")) return;
  const std::size_t open_end = text.find('>');
  const std::size_t close = text.find(kEnd);
  if (open_end == std::string::npos || close == std::string::npos || close < open_end) return;
  const std::string head = text.substr(0, open_end);
  const auto attribute = [&](const std::string& name) -> std::string {
    const std::size_t at = head.find(name + "=\"");
    if (at == std::string::npos) return "";
    const std::size_t from = at + name.size() + 2;
    return head.substr(from, head.find('"', from) - from);
  };
  variables["emotion"] = attribute("type");
  variables["strength"] = attribute("value");
  variables["text"] =
      text.substr(open_end + 1, close - open_end - 1) + text.substr(close + kEnd.size());
}

}  // namespace am
