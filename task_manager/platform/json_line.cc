#include "task_manager/platform/json_line.h"

#include <cmath>
#include <nlohmann/json.hpp>

namespace vxml {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kMaxInteger = 9007199254740992.0;  // 2^53: doubles below are exact

template <typename AnyJson>
std::string Dump(const AnyJson& json) {
  return json.dump(-1, ' ', false, AnyJson::error_handler_t::replace);
}

}  // namespace

std::string JsonText(const nlohmann::json& json) { return Dump(json); }

JsonLine::JsonLine() : object_(std::make_unique<Json>(Json::object())) {}
JsonLine::~JsonLine() = default;

JsonLine& JsonLine::Text(std::string_view name, std::string_view value) {
  (*object_)[std::string(name)] = value;
  return *this;
}
JsonLine& JsonLine::Number(std::string_view name, double value) {
  Json& field = (*object_)[std::string(name)];
  if (std::trunc(value) == value && std::abs(value) < kMaxInteger) {
    field = static_cast<long long>(value);
  } else {
    field = value;  // null if it is not finite
  }
  return *this;
}
JsonLine& JsonLine::Bool(std::string_view name, bool value) {
  (*object_)[std::string(name)] = value;
  return *this;
}
JsonLine& JsonLine::List(std::string_view name, const std::vector<std::string>& texts) {
  (*object_)[std::string(name)] = texts;
  return *this;
}
JsonLine& JsonLine::Raw(std::string_view name, std::string_view json) {
  Json value = json == "undefined" ? Json() : Json::parse(json, nullptr, false);
  if (value.is_discarded()) value = json;
  (*object_)[std::string(name)] = std::move(value);
  return *this;
}
JsonLine& JsonLine::Add(const JsonLine& other) {
  object_->update(*other.object_);
  return *this;
}
JsonLine& JsonLine::Add(std::string_view line) {
  const Json other = Json::parse(line, nullptr, false);
  if (other.is_object()) object_->update(other);
  return *this;
}
std::string JsonLine::str() const { return Dump(*object_); }

}  // namespace vxml
