#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "vm_protocol/core/result.h"
#include "vm_protocol/http/http.h"

/// What endpoints answer, read with care: everything here takes any bytes.
namespace vm {

/// JSON from outside; nothing for what is none, or nests deeper than 32.
std::optional<nlohmann::json> ParseAnswer(std::string_view text);
/// The string at a key; "" where there is none.
std::string TextAt(const nlohmann::json& object, const char* key);
/// What an answer says under "error"; nothing where there is no such member.
std::optional<std::string> ErrorIn(const nlohmann::json& answer);

/// At most 200 bytes on one line, for people.
std::string ShownAnswer(std::string_view text);
/// What an endpoint says of an error in its body, for people: at most 200 bytes on one line.
std::string ErrorTextOf(std::string_view body);
/// What a status other than 2xx means: kAccess (401, 403), kBusy (429), else kUnavailable.
/// Redirections are errors: they are not followed, so that a key goes nowhere else.
Error StatusError(const HttpHead& head, std::string_view body);
/// An endpoint may show our key in what it says of an error: *** in its place.
std::string WithoutSecret(std::string text, const std::string& secret);

}  // namespace vm
