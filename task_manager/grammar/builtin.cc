#include "task_manager/grammar/builtin.h"

#include <array>
#include <charconv>

#include "embedded/dtmf_boolean.h"
#include "embedded/dtmf_currency.h"
#include "embedded/dtmf_date.h"
#include "embedded/dtmf_digits.h"
#include "embedded/dtmf_number.h"
#include "embedded/dtmf_phone.h"
#include "embedded/dtmf_time.h"
#include "embedded/en_boolean.h"
#include "embedded/en_currency.h"
#include "embedded/en_date.h"
#include "embedded/en_digits.h"
#include "embedded/en_number.h"
#include "embedded/en_numbers.h"
#include "embedded/en_phone.h"
#include "embedded/en_time.h"
#include "embedded/ja_boolean.h"
#include "embedded/ja_currency.h"
#include "embedded/ja_date.h"
#include "embedded/ja_digits.h"
#include "embedded/ja_number.h"
#include "embedded/ja_numbers.h"
#include "embedded/ja_phone.h"
#include "embedded/ja_time.h"

namespace vxml::srgs {
namespace {

using Source = std::string_view (*)();

struct Type {
  std::string_view name;
  Source english, japanese, dtmf;
};

constexpr int kLongest = 1000;  ///< of digits without a maxlength

const std::array<Type, 7> kTypes = {{
    {"boolean", embedded::en_boolean, embedded::ja_boolean, embedded::dtmf_boolean},
    {"currency", embedded::en_currency, embedded::ja_currency, embedded::dtmf_currency},
    {"date", embedded::en_date, embedded::ja_date, embedded::dtmf_date},
    {"digits", embedded::en_digits, embedded::ja_digits, embedded::dtmf_digits},
    {"number", embedded::en_number, embedded::ja_number, embedded::dtmf_number},
    {"phone", embedded::en_phone, embedded::ja_phone, embedded::dtmf_phone},
    {"time", embedded::en_time, embedded::ja_time, embedded::dtmf_time},
}};

const Type* FindType(const std::string& name) {
  for (const Type& type : kTypes) {
    if (type.name == name) return &type;
  }
  return nullptr;
}

void Replace(std::string& text, const std::string& from, const std::string& to) {
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at)) {
    text.replace(at, from.size(), to);
    at += to.size();
  }
}

bool ReadLength(const std::string& text, int& value) {
  const auto read = std::from_chars(text.data(), text.data() + text.size(), value);
  return read.ec == std::errc() && read.ptr == text.data() + text.size() && value >= 0;
}

vm::Result<std::string> Repeat(const BuiltinName& name) {
  int min = 1;
  int max = kLongest;
  bool exact = false;
  bool has_max = false;
  for (const auto& [key, value] : name.parameters) {
    int number = 0;
    if (key != "length" && key != "minlength" && key != "maxlength") continue;
    if (!ReadLength(value, number)) {
      return vm::Fail(vm::Errc::kBadValue, "digits: " + key + " '" + value + "' is not a length");
    }
    if (key == "length") {
      if (exact || name.parameters.contains("minlength") || name.parameters.contains("maxlength")) {
        return vm::Fail(vm::Errc::kBadValue, "digits: length together with minlength or maxlength");
      }
      min = max = number;
      exact = true;
    } else if (key == "minlength") {
      min = number;
    } else {
      max = number;
      has_max = true;
    }
  }
  if (min > max || (has_max && max == 0)) {
    return vm::Fail(vm::Errc::kBadValue, "digits: minlength " + std::to_string(min) +
                                             " is above maxlength " + std::to_string(max));
  }
  return "<" + std::to_string(min) + "-" + std::to_string(max) + ">";
}

vm::Result<std::string> Key(const BuiltinName& name, const std::string& parameter,
                            const std::string& otherwise) {
  const auto found = name.parameters.find(parameter);
  if (found == name.parameters.end()) return otherwise;
  const std::string& key = found->second;
  if (key.size() != 1 || std::string_view("0123456789*#").find(key[0]) == std::string_view::npos) {
    return vm::Fail(vm::Errc::kBadValue, "boolean: " + parameter + " '" + key + "' is no key");
  }
  return "\"" + key + "\"";
}

}  // namespace

bool IsBuiltinType(const std::string& type) { return FindType(type) != nullptr; }

bool HasBuiltinLanguage(const std::string& language) {
  const std::string primary = language.substr(0, language.find_first_of("-_"));
  return primary.empty() || primary == "en" || primary == "ja" || primary == "EN" ||
         primary == "JA";
}

BuiltinName ParseBuiltin(const std::string& text) {
  BuiltinName name;
  const std::size_t query = text.find('?');
  name.type = text.substr(0, query);
  if (query == std::string::npos) return name;
  for (std::size_t at = query + 1; at <= text.size();) {
    const std::size_t end = std::min(text.find_first_of(";&", at), text.size());
    const std::string part = text.substr(at, end - at);
    const std::size_t equals = part.find('=');
    if (equals != std::string::npos) {
      name.parameters[part.substr(0, equals)] = part.substr(equals + 1);
    }
    at = end + 1;
  }
  return name;
}

vm::Result<std::unique_ptr<Grammar>> MakeBuiltin(const BuiltinName& name, Mode mode,
                                                 const std::string& language) {
  const Type* type = FindType(name.type);
  if (!type) {
    return vm::Fail(vm::Errc::kUnavailable, "there is no built-in type '" + name.type + "'");
  }
  if (mode == Mode::kVoice && !HasBuiltinLanguage(language)) {
    return vm::Fail(vm::Errc::kUnavailable,
                    "built-in types are not known in '" + language + "' (en and ja are)");
  }
  const bool japanese = language.starts_with("ja") || language.starts_with("JA");
  std::string source;
  if (mode == Mode::kDtmf) {
    source = type->dtmf();
  } else {
    source = std::string(japanese ? embedded::ja_numbers() : embedded::en_numbers());
    source += japanese ? type->japanese() : type->english();
  }
  auto repeat = Repeat(name);
  if (!repeat) return std::unexpected(repeat.error());
  auto yes = Key(name, "y", "1");
  auto no = Key(name, "n", "2");
  if (!yes || !no) return std::unexpected(yes ? no.error() : yes.error());
  if (*yes == *no) return vm::Fail(vm::Errc::kBadValue, "boolean: y and n are the same key");
  Replace(source, "@REPEAT@", *repeat);
  Replace(source, "@YES@", *yes);
  Replace(source, "@NO@", *no);
  GrammarContext context;
  context.uri = "builtin:" + std::string(mode == Mode::kDtmf ? "dtmf/" : "grammar/") + name.type;
  context.language = language;
  context.mode = mode;
  auto grammar = CompileAbnf(source, context);
  if (!grammar) return grammar;
  (*grammar)->root = "main";
  (*grammar)->tag_format = "semantics/1.0";
  (*grammar)->split_digits = true;
  return grammar;
}

}  // namespace vxml::srgs
