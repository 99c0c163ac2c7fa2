#include "vm_protocol/http/answer.h"

#include <nlohmann/json.hpp>

#include "vm_protocol/core/utf8.h"

namespace vm {
namespace {

using nlohmann::json;

constexpr std::size_t kMostShown = 200;
constexpr int kDeepest = 32;

}  // namespace

std::optional<json> ParseAnswer(std::string_view text) {
  bool too_deep = false;
  json value = json::parse(
      text,
      [&too_deep](int depth, json::parse_event_t, json&) {
        too_deep = too_deep || depth > kDeepest;
        return !too_deep;
      },
      false);
  if (too_deep || value.is_discarded()) return {};
  return value;
}

std::string TextAt(const json& object, const char* key) {
  const auto found = object.find(key);
  return found != object.end() && found->is_string() ? found->get<std::string>() : "";
}

std::optional<std::string> ErrorIn(const json& answer) {
  const auto error = answer.find("error");
  if (error == answer.end() || error->is_null()) return {};
  if (error->is_string()) return error->get<std::string>();
  if (!error->is_object()) return "unknown error";
  const std::string message = TextAt(*error, "message");
  return message.empty() ? "unknown error" : message;
}

std::string ShownAnswer(std::string_view text) { return ShownUtf8(CutUtf8(text, kMostShown)); }

std::string ErrorTextOf(std::string_view body) {
  const auto value = ParseAnswer(body);
  if (value && value->is_object()) {
    if (const auto error = ErrorIn(*value)) return ShownAnswer(*error);
    for (const char* key : {"message", "detail"}) {
      if (const std::string text = TextAt(*value, key); !text.empty()) return ShownAnswer(text);
    }
  }
  return ShownAnswer(body);
}

Error StatusError(const HttpHead& head, std::string_view body) {
  const std::string number = std::to_string(head.status);
  if (head.status >= 300 && head.status < 400) {
    const auto place = head.headers.find("location");
    return {Errc::kUnavailable,
            number + ": it has moved to '" +
                (place == head.headers.end() ? "" : ShownAnswer(place->second)) +
                "'; redirections are not followed, so that the key goes nowhere else",
            0};
  }
  const std::string said = number + ": " + ErrorTextOf(body);
  if (head.status == 401 || head.status == 403) {
    return {Errc::kAccess, "the key is refused, " + said, 0};
  }
  if (head.status == 429) return {Errc::kBusy, "too many requests, " + said, 0};
  return {Errc::kUnavailable, said, 0};
}

std::string WithoutSecret(std::string text, const std::string& secret) {
  if (secret.empty()) return text;
  for (std::size_t at = text.find(secret); at != std::string::npos;
       at = text.find(secret, at + 3)) {
    text.replace(at, secret.size(), "***");
  }
  return text;
}

}  // namespace vm
