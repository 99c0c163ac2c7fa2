#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

#include "gateway/face/live_face.h"

/// What passes over a client's WebSocket beside its sound: JSON, one object a message
/// (docs/gateway.md).
namespace gateway {

enum class Control { kClear, kEnd };
/// {"type": "clear"} and {"type": "end"}. Errors: kSyntax, kBadValue.
vm::Result<Control> ReadControl(std::string_view text);

/// `more`: further members.
std::string ReadyText(const LiveFace& face, const nlohmann::json& more);
std::string FrameText(const WeightSet& set, const LiveFace::Moment& moment);
std::string EndText(double at_s);
std::string ClearedText();
std::string ErrorText(std::string_view what);

}  // namespace gateway
