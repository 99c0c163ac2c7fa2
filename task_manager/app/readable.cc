#include "task_manager/app/readable.h"

#include <cstdio>
#include <nlohmann/json.hpp>

#include "vm_protocol/core/lower_case.h"

namespace vxml {
namespace {

using Json = nlohmann::json;

std::string TextOf(const Json& line, const char* name) {
  return line.contains(name) && line[name].is_string() ? line[name].get<std::string>() : "";
}

/// "(happy, sad)", "" for none.
std::string FeelingsOf(const Json& line) {
  std::string text;
  for (const auto& feeling : line.value("feelings", Json::array())) {
    text += (text.empty() ? "(" : ", ") + feeling.get<std::string>();
  }
  return text.empty() ? "" : vm::LowerCase(text) + ")";
}

std::string SaidBy(const Json& line) {
  std::string said = TextOf(line, "text");
  for (const auto& uri : line.value("audio", Json::array())) {
    said += (said.empty() ? "[" : " [") + uri.get<std::string>() + "]";
  }
  return said;
}

/// "1:02.5 "
std::string Clock(const Json& line) {
  const auto tenths = static_cast<long long>(line.value("t", 0.0) / 100);
  char text[40];
  std::snprintf(text, sizeof text, "%lld:%02lld.%lld ", tenths / 600, tenths / 10 % 60,
                tenths % 10);
  return text;
}

/// What the user did, "" if the line tells something else.
std::string UserDid(const Json& line, const std::string& type) {
  if (type == "result") {
    const std::string words = TextOf(line, "utterance");
    const bool unknown = IsUnknown(words);
    const std::string keys = TextOf(line, "mode") == "dtmf" ? "keys " : "";
    const std::string missed = line.value("match", true) ? "" : "(not understood)";
    return unknown ? missed : keys + words + (missed.empty() ? "" : " " + missed);
  }
  if (type == "event" && TextOf(line, "name").starts_with("noinput")) return "(silent)";
  if (type == "ignored") return TextOf(line, "input") + " (not heard)";
  if (type == "recorded") {
    char text[40];
    std::snprintf(text, sizeof text, "(recorded %.1f s)", line.value("ms", 0.0) / 1000);
    return text;
  }
  return "";
}

}  // namespace

bool IsUnknown(const std::string& utterance) { return utterance.empty() || utterance == "?"; }

std::string Readable(const std::string& json_line, Sides sides) {
  const auto line = Json::parse(json_line, nullptr, false);
  if (line.is_discarded()) return json_line;
  if (!line.is_object()) return "";
  const std::string type = TextOf(line, "type");
  std::string session;
  if (line.contains("session")) session = "[" + line["session"].dump() + "] ";
  const std::string head = session + (sides == Sides::kBoth ? Clock(line) : "");
  if (type == "prompt") {
    const std::string feelings = FeelingsOf(line), said = SaidBy(line);
    if (said.empty()) return "";
    const std::string blank = feelings.empty() ? "" : " ";
    if (sides == Sides::kBoth) return head + "agent" + blank + feelings + ": " + said;
    return head + feelings + blank + said;
  }
  if (sides == Sides::kBoth) {
    if (const std::string did = UserDid(line, type); !did.empty()) return head + "user: " + did;
  }
  if (type == "log") {
    return head + "(log " + TextOf(line, "label") + ": " + TextOf(line, "text") + ")";
  }
  if (type == "event" && TextOf(line, "name").starts_with("error")) {
    return head + "(" + TextOf(line, "name") + ": " + TextOf(line, "message") + ")";
  }
  if (type == "exit") {
    const auto value = line.value("value", Json());
    return head + "(" + TextOf(line, "reason") + (value.is_null() ? "" : " " + value.dump()) + ")";
  }
  return "";
}

}  // namespace vxml
