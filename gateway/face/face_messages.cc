#include "gateway/face/face_messages.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "vm_protocol/http/answer.h"

namespace gateway {

using nlohmann::json;

vm::Result<Control> ReadControl(std::string_view text) {
  const auto message = vm::ParseAnswer(text);
  if (!message || !message->is_object()) {
    return vm::Fail(vm::Errc::kSyntax, "found '" + vm::ShownAnswer(text) +
                                           "', expected {\"type\": \"clear\"} or \"end\", or sound "
                                           "in a binary message");
  }
  const std::string type = vm::TextAt(*message, "type");
  if (type == "clear") return Control::kClear;
  if (type == "end") return Control::kEnd;
  return vm::Fail(vm::Errc::kBadValue,
                  "type '" + vm::ShownAnswer(type) + "' found, clear or end expected");
}

std::string ReadyText(const LiveFace& face, const json& more) {
  const LiveFace::Settings& settings = face.settings();
  json ready{
      {"type", "ready"},          {"set", settings.set->name()}, {"names", settings.set->names()},
      {"rate", settings.rate_hz}, {"fps", settings.fps},         {"ahead", face.ahead_s()}};
  ready.update(more);
  return ready.dump();
}

std::string FrameText(const WeightSet& set, const LiveFace::Moment& moment) {
  // By hand: a float as the library writes it has nine digits, three are enough.
  std::string text = fmt::format(R"({{"type":"frame","t":{:g},)", moment.at_s);
  const auto most = std::ranges::max_element(moment.weights);
  if (set.visemes()) {
    const std::string& name = set.names()[static_cast<std::size_t>(most - moment.weights.begin())];
    const bool number = std::ranges::all_of(name, [](char c) { return c >= '0' && c <= '9'; });
    text += "\"viseme\":" + (number ? name : "\"" + name + "\"") + ",";
  }
  text += "\"weights\":[";
  for (const float weight : moment.weights) text += fmt::format("{:.3g},", weight);
  text.back() = ']';
  return text + "}";
}

std::string EndText(double at_s) { return fmt::format(R"({{"type":"end","t":{:g}}})", at_s); }

std::string ClearedText() { return R"({"type":"cleared"})"; }

std::string ErrorText(std::string_view what) {
  return json{{"type", "error"}, {"text", what}}.dump(-1, ' ', false,
                                                      json::error_handler_t::replace);
}

}  // namespace gateway
