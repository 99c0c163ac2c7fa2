#pragma once

#include <string>
#include <string_view>

namespace vxml {

/// "text" with JSON's escapes and quotes.
std::string JsonQuote(std::string_view text);

/// One JSON object on one line, fields in the order they are added.
class JsonLine {
 public:
  JsonLine& Text(std::string_view name, std::string_view value);
  JsonLine& Number(std::string_view name, double value);
  JsonLine& Bool(std::string_view name, bool value);
  /// `json` is JSON already; "undefined" becomes null.
  JsonLine& Raw(std::string_view name, std::string_view json);
  std::string str() const { return "{" + fields_ + "}"; }

 private:
  void Name(std::string_view name);
  std::string fields_;
};

}  // namespace vxml
