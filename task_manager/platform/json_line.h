#pragma once

#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace vxml {

/// JSON on one line. Bytes that are no UTF-8 become U+FFFD.
std::string JsonText(const nlohmann::json& json);

/// One JSON object on one line, fields in the order they are added. A name twice: the later value
/// stands in the place of the earlier one.
class JsonLine {
 public:
  JsonLine();
  ~JsonLine();
  JsonLine(const JsonLine&) = delete;
  JsonLine& operator=(const JsonLine&) = delete;

  JsonLine& Text(std::string_view name, std::string_view value);
  JsonLine& Number(std::string_view name, double value);
  JsonLine& Bool(std::string_view name, bool value);
  JsonLine& List(std::string_view name, const std::vector<std::string>& texts);
  /// `json` is JSON already; "undefined" becomes null, what is no JSON a text.
  JsonLine& Raw(std::string_view name, std::string_view json);
  /// The fields of another line behind these.
  JsonLine& Add(const JsonLine& other);
  /// The same of a line as str() writes it.
  JsonLine& Add(std::string_view line);
  std::string str() const;

 private:
  std::unique_ptr<nlohmann::ordered_json> object_;
};

}  // namespace vxml
