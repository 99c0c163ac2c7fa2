#include "agent_manager/config.h"

#include <algorithm>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "vm_protocol/core/message.h"

namespace am {
namespace {

using nlohmann::json;
using vm::Errc;
using vm::Fail;
using vm::Result;

/// A fault at a key; turned into a vm::Error at the edge of this file.
struct ConfigFault {
  std::string key;
  std::string text;
};

std::string Shown(const json& value) {
  std::string text = value.dump();
  return text.size() > 60 ? text.substr(0, 57) + "..." : text;
}

[[noreturn]] void Wrong(const std::string& key, const json& value, const std::string& expected) {
  throw ConfigFault{key, "found " + Shown(value) + ", expected " + expected};
}

std::string Text(const json& value, const std::string& key) {
  if (!value.is_string()) Wrong(key, value, "a string");
  return value.get<std::string>();
}

std::vector<std::string> Texts(const json& value, const std::string& key) {
  if (!value.is_array()) Wrong(key, value, "a list of strings");
  std::vector<std::string> texts;
  for (std::size_t i = 0; i < value.size(); ++i)
    texts.push_back(Text(value[i], key + "[" + std::to_string(i) + "]"));
  return texts;
}

template <typename T>
T OneOf(const json& value, const std::string& key,
        const std::vector<std::pair<std::string, T>>& words) {
  std::string expected;
  for (const auto& [word, meaning] : words) {
    if (value.is_string() && value.get<std::string>() == word) return meaning;
    expected += (expected.empty() ? "" : ", ") + word;
  }
  Wrong(key, value, "one of " + expected);
}

/// Calls the reader of each member; a member without a reader is a fault.
using Readers = std::map<std::string, std::function<void(const json&, const std::string& key)>>;
void ReadObject(const json& object, const std::string& key, const Readers& readers) {
  if (!object.is_object()) Wrong(key.empty() ? "(top)" : key, object, "an object");
  for (const auto& [name, value] : object.items()) {
    const std::string path = key.empty() ? name : key + "." + name;
    const auto reader = readers.find(name);
    if (reader == readers.end()) {
      std::string known;
      for (const auto& [word, unused] : readers) known += (known.empty() ? "" : ", ") + word;
      throw ConfigFault{path, "unknown key, expected one of " + known};
    }
    reader->second(value, path);
  }
}

ModuleConfig ReadModule(const json& object, const std::string& key) {
  ModuleConfig module;
  ReadObject(
      object, key,
      {{"name",
        [&](const json& v, const std::string& k) {
          module.name = Text(v, k);
          if (!vm::IsModuleName(module.name)) Wrong(k, v, "letters, digits, '_' or '-'");
        }},
       {"command",
        [&](const json& v, const std::string& k) {
          module.command = v.is_string()
                               ? std::vector<std::string>{"/bin/sh", "-c", "exec " + Text(v, k)}
                               : Texts(v, k);
          if (module.command.empty()) Wrong(k, v, "a program and its arguments");
        }},
       {"connect", [&](const json& v, const std::string& k) { module.connect = Text(v, k); }},
       {"cwd", [&](const json& v, const std::string& k) { module.cwd = Text(v, k); }},
       {"env",
        [&](const json& v, const std::string& k) {
          if (!v.is_object()) Wrong(k, v, "an object of strings");
          for (const auto& [name, value] : v.items())
            module.env.push_back(name + "=" + Text(value, k + "." + name));
        }},
       {"restart",
        [&](const json& v, const std::string& k) {
          module.restart = OneOf<Restart>(v, k,
                                          {{"never", Restart::kNever},
                                           {"on-failure", Restart::kOnFailure},
                                           {"always", Restart::kAlways}});
        }},
       {"dialect",
        [&](const json& v, const std::string& k) {
          module.dialect = OneOf<Dialect>(v, k,
                                          {{"auto", Dialect::kAuto},
                                           {"modern", Dialect::kModern},
                                           {"original", Dialect::kOriginal}});
        }},
       {"framing",
        [&](const json& v, const std::string& k) {
          module.framing = OneOf<std::string>(v, k, {{"lf", "lf"}, {"mmi", "mmi"}});
        }},
       {"encoding", [&](const json& v, const std::string& k) {
          module.encoding = OneOf<std::string>(
              v, k, {{"utf-8", "utf-8"}, {"euc-jp", "euc-jp"}, {"shift_jis", "shift_jis"}});
        }}});
  if (module.name.empty()) throw ConfigFault{key + ".name", "missing, expected the module's name"};
  if (module.command.empty() == module.connect.empty())
    throw ConfigFault{key, "expected either command or connect"};
  return module;
}

std::string ReadFile(const std::string& path, const std::string& key) {
  std::ifstream file(path, std::ios::binary);
  std::stringstream text;
  if (!file || !(text << file.rdbuf())) throw ConfigFault{key, "cannot read '" + path + "'"};
  return text.str();
}

std::size_t LineAt(std::string_view text, std::size_t at) {
  return 1 + static_cast<std::size_t>(std::ranges::count(text.substr(0, at), '\n'));
}

/// The line of the deepest part of `key` that can be found in the text, going from part to part.
std::size_t LineOf(std::string_view text, const std::string& key) {
  std::size_t at = 0;
  std::string part;
  const auto advance = [&] {
    if (part.empty()) return;
    if (std::ranges::all_of(part, [](char c) { return c >= '0' && c <= '9'; })) {
      for (int skip = std::stoi(part); skip > 0; --skip) {
        const std::size_t close = text.find('}', at);
        if (close != std::string_view::npos) at = close + 1;
      }
    } else if (const std::size_t found = text.find("\"" + part + "\"", at);
               found != std::string_view::npos) {
      at = found;
    }
    part.clear();
  };
  for (const char c : key) {
    if (c == '.' || c == '[' || c == ']') {
      advance();
    } else {
      part += c;
    }
  }
  advance();
  return LineAt(text, at);
}

}  // namespace

Result<Config> ParseConfig(std::string_view text, const std::string& origin,
                           const std::string& folder) {
  json root;
  try {
    root = json::parse(text, nullptr, true, true);
  } catch (const json::parse_error& error) {
    const std::string what = error.what();
    const std::size_t colon = what.find(": ");
    return Fail(Errc::kSyntax,
                origin + " line " +
                    std::to_string(LineAt(text, error.byte > 0 ? error.byte - 1 : 0)) +
                    ": not JSON: " + (colon == std::string::npos ? what : what.substr(colon + 2)));
  }
  try {
    Config config;
    ReadObject(
        root, "",
        {{"modules",
          [&](const json& v, const std::string& k) {
            if (!v.is_array()) Wrong(k, v, "a list of modules");
            std::set<std::string> names;
            for (std::size_t i = 0; i < v.size(); ++i) {
              const std::string key = k + "[" + std::to_string(i) + "]";
              config.modules.push_back(ReadModule(v[i], key));
              if (!names.insert(config.modules.back().name).second)
                throw ConfigFault{key + ".name", "the name is taken twice"};
            }
          }},
         {"listen", [&](const json& v, const std::string& k) { config.listen = Texts(v, k); }},
         {"broadcast",
          [&](const json& v, const std::string& k) { config.broadcast = Texts(v, k); }},
         {"clock",
          [&](const json& v, const std::string& k) {
            config.virtual_clock = OneOf<bool>(v, k, {{"real", false}, {"virtual", true}});
          }},
         {"log", [&](const json& v, const std::string& k) { config.log = Text(v, k); }},
         {"start_limit_ms",
          [&](const json& v, const std::string& k) {
            if (!v.is_number_integer() || v.get<long>() < 100 || v.get<long>() > 600000)
              Wrong(k, v, "a whole number, 100 to 600000");
            config.start_limit = std::chrono::milliseconds(v.get<long>());
          }},
         {"macros", [&](const json& v, const std::string& k) {
            if (!v.is_object()) Wrong(k, v, "an object: name to steps, or to a file's name");
            for (const auto& [name, steps] : v.items()) {
              const std::string key = k + "." + name;
              config.macros[name] = steps.is_string()
                                        ? ReadFile(folder + "/" + steps.get<std::string>(), key)
                                        : steps.dump();
            }
          }}});
    return config;
  } catch (const ConfigFault& fault) {
    return Fail(Errc::kBadValue, origin + " line " + std::to_string(LineOf(text, fault.key)) +
                                     ": " + fault.key + ": " + fault.text);
  }
}

}  // namespace am
