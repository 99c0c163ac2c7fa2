#include "task_manager/app/readable.h"

#include <nlohmann/json.hpp>

namespace vxml {

std::string Readable(const std::string& json_line) {
  const auto line = nlohmann::json::parse(json_line, nullptr, false);
  if (line.is_discarded()) return json_line;
  const auto text = [&](const char* name) {
    return line.contains(name) && line[name].is_string() ? line[name].get<std::string>() : "";
  };
  const std::string type = text("type");
  if (type == "prompt") {
    std::string said = text("text");
    if (line.contains("audio")) {
      for (const auto& uri : line["audio"]) said += " [" + uri.get<std::string>() + "]";
    }
    return said;
  }
  if (type == "log") return "(log " + text("label") + ": " + text("text") + ")";
  if (type == "command") return "(" + text("line") + ")";
  if (type == "event" && text("name").starts_with("error")) {
    return "(" + text("name") + ": " + text("message") + ")";
  }
  if (type == "exit") {
    const auto value = line.value("value", nlohmann::json());
    return "(" + text("reason") + (value.is_null() ? "" : " " + value.dump()) + ")";
  }
  return "";
}

}  // namespace vxml
