#include "task_manager/document/values.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "task_manager/document/schema.h"
#include "vm_protocol/xml/node.h"

namespace vxml {
namespace {

struct ValueRule {
  std::string_view attribute;
  std::string_view elements;  ///< "" = wherever the attribute stands
  std::string_view values;    ///< one of these, or @KIND
};

constexpr ValueRule kRules[] = {
    {"scope", "form menu", "dialog document"},
    {"modal", "", "true false"},
    {"beep", "", "true false"},
    {"dtmfterm", "", "true false"},
    {"bridge", "", "true false"},
    {"dtmf", "menu", "true false"},
    {"dtmf", "choice option link", "@keys"},
    {"maxage", "", "@seconds"},
    {"maxstale", "", "@seconds"},
    {"id", "form menu", "@id"},
    {"bargein", "", "true false"},
    {"bargeintype", "", "speech hotword"},
    {"accept", "", "exact approximate"},
    {"mode", "filled", "any all"},
    {"method", "", "get post"},
    {"fetchhint", "", "prefetch safe"},
    {"valuetype", "", "data ref"},
    {"count", "", "@count"},
    {"timeout", "", "@time"},
    {"fetchtimeout", "", "@time"},
    {"maxtime", "", "@time"},
    {"finalsilence", "", "@time"},
    {"connecttimeout", "", "@time"},
};

constexpr std::string_view kDigits = "0123456789";

bool IsOf(std::string_view text, std::string_view signs) {
  return !text.empty() && text.find_first_not_of(signs) == std::string_view::npos;
}

bool IsCount(std::string_view text) {
  return IsOf(text, kDigits) && text.find_first_not_of('0') != std::string_view::npos;
}

bool IsKeys(std::string_view text) { return IsOf(text, "0123456789*#ABCD \t\r\n"); }

}  // namespace

bool IsTimeDesignation(std::string_view text) {
  if (text.starts_with("+")) text.remove_prefix(1);
  const std::size_t unit = text.find_first_not_of("0123456789.");
  if (unit == std::string_view::npos || unit == 0) return false;
  const std::string_view number = text.substr(0, unit);
  if (number == "." || std::count(number.begin(), number.end(), '.') > 1) return false;
  return text.substr(unit) == "s" || text.substr(unit) == "ms";
}

std::optional<std::chrono::milliseconds> ParseTime(std::string_view text) {
  using std::chrono::milliseconds;
  text = vm::xml::Trim(text);
  if (text.starts_with("+")) text.remove_prefix(1);
  double number = 0;
  const auto read = std::from_chars(text.data(), text.data() + text.size(), number);
  if (read.ec != std::errc() || !(number >= 0 && number <= 1e9)) return {};  // nor NaN
  const std::string_view unit(read.ptr,
                              static_cast<std::size_t>(text.data() + text.size() - read.ptr));
  if (unit == "s") return milliseconds(static_cast<long long>(number * 1000 + 0.5));
  if (unit == "ms") return milliseconds(static_cast<long long>(number + 0.5));
  return {};
}

double NumberIn(std::string_view text, double min, double max, double otherwise) {
  text = vm::xml::Trim(text);
  if (text.starts_with('+')) text.remove_prefix(1);
  double number = otherwise;
  const auto read = std::from_chars(text.data(), text.data() + text.size(), number);
  if (read.ec != std::errc() || std::isnan(number)) return otherwise;
  return std::clamp(number, min, max);
}

std::string WrongValue(std::string_view element, std::string_view attribute,
                       std::string_view value) {
  value = vm::xml::Trim(value);
  for (const ValueRule& rule : kRules) {
    if (rule.attribute != attribute) continue;
    if (!rule.elements.empty() && !HasWord(rule.elements, element)) continue;
    if (rule.values == "@time") {
      return IsTimeDesignation(value) ? "" : "expected a time as 5s or 300ms";
    }
    if (rule.values == "@count") return IsCount(value) ? "" : "expected 1 or more";
    if (rule.values == "@keys") return IsKeys(value) ? "" : "expected keys 0-9 * # A-D";
    if (rule.values == "@seconds") return IsOf(value, kDigits) ? "" : "expected whole seconds";
    if (rule.values == "@id") {
      return value.find_first_of(" \t\r\n") == std::string_view::npos ? "" : "expected one word";
    }
    if (HasWord(rule.values, value)) return "";
    return "expected one of " + std::string(rule.values);
  }
  return "";
}

}  // namespace vxml
