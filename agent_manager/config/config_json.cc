#include "agent_manager/config/config_json.h"

#include <algorithm>
#include <charconv>
#include <iterator>
#include <set>

#include "vm_protocol/core/text_file.h"
#include "vm_protocol/core/utf8.h"

namespace am {
namespace {

std::string Shown(const json& value) {
  std::string text = value.dump();
  return text.size() > 60 ? std::string(vm::CutUtf8(text, 57)) + "..." : text;
}

}  // namespace

void Wrong(const std::string& key, const json& value, const std::string& expected) {
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

long Whole(const json& value, const std::string& key, long least, long most) {
  if (!value.is_number_integer() || value.get<long>() < least || value.get<long>() > most)
    Wrong(key, value, "a whole number, " + std::to_string(least) + " to " + std::to_string(most));
  return value.get<long>();
}

bool Flag(const json& value, const std::string& key) {
  if (!value.is_boolean()) Wrong(key, value, "true or false");
  return value.get<bool>();
}

std::chrono::milliseconds Millis(const json& value, const std::string& key, long least, long most) {
  return std::chrono::milliseconds(Whole(value, key, least, most));
}

void ReadList(const json& list, const std::string& key, const std::string& expected,
              const std::function<void(const json&, const std::string& key)>& read) {
  if (!list.is_array()) Wrong(key, list, expected);
  for (std::size_t i = 0; i < list.size(); ++i) read(list[i], key + "[" + std::to_string(i) + "]");
}

std::string ReadTextFile(const std::string& path, const std::string& key) {
  constexpr std::size_t kMaxMacroBytes = 4u << 20;
  auto text = vm::ReadTextFile(path, kMaxMacroBytes);
  if (!text) throw ConfigFault{key, text.error().text};
  return std::move(*text);
}

namespace {

std::size_t LineAt(std::string_view text, std::size_t at) {
  return 1 + static_cast<std::size_t>(std::ranges::count(text.substr(0, at), '\n'));
}

/// Finds the line of a key such as "modules[1].env.A" in JSON text that has been parsed before.
class KeyLocator {
 public:
  explicit KeyLocator(std::string_view text) : text_(text) {}

  /// The line of the deepest part of the path that exists.
  std::size_t LineOf(std::string_view path) {
    Skip();
    std::size_t found = at_;
    while (!path.empty()) {
      const bool index = path.front() == '[';
      const std::size_t end = std::min(path.find_first_of(index ? "]" : ".["), path.size());
      const std::string part(path.substr(index ? 1 : 0, end - (index ? 1 : 0)));
      path.remove_prefix(index ? std::min(end + 1, path.size()) : end);
      if (path.starts_with('.')) path.remove_prefix(1);
      std::size_t number = 0;
      if (index &&
          std::from_chars(part.data(), part.data() + part.size(), number).ec != std::errc())
        break;  // a bracket in a member's name
      if (!(index ? EnterElement(number) : EnterMember(part, found))) break;
      if (index) found = at_;
    }
    return LineAt(text_, found);
  }

 private:
  void Skip() {  // blanks and comments
    while (at_ < text_.size()) {
      if (text_.substr(at_).starts_with("//")) {
        at_ = std::min(text_.find('\n', at_), text_.size());
      } else if (text_.substr(at_).starts_with("/*")) {
        at_ = std::min(text_.find("*/", at_), text_.size() - 2) + 2;
      } else if (std::string_view(" \t\r\n,:").find(text_[at_]) != std::string_view::npos) {
        ++at_;
      } else {
        return;
      }
    }
  }
  std::string_view String() {
    const std::size_t start = ++at_;
    while (at_ < text_.size() && text_[at_] != '"') at_ += text_[at_] == '\\' ? 2 : 1;
    const std::size_t end = std::min(at_, text_.size());
    at_ = std::min(at_ + 1, text_.size());
    return text_.substr(start, end - start);
  }
  void SkipValue() {
    int depth = 0;
    do {
      Skip();
      if (at_ >= text_.size()) return;
      const char c = text_[at_];
      if (c == '"') {
        String();
      } else if (c == '{' || c == '[') {
        ++depth;
        ++at_;
      } else if (c == '}' || c == ']') {
        --depth;
        ++at_;
      } else {
        at_ = std::min(text_.find_first_of(" \t\r\n,]}", at_), text_.size());
      }
    } while (depth > 0);
  }
  bool Open(char bracket) {
    Skip();
    if (at_ >= text_.size() || text_[at_] != bracket) return false;
    ++at_;
    return true;
  }
  /// Leaves `at_` before the member's value and `key_at` at its key.
  bool EnterMember(const std::string& name, std::size_t& key_at) {
    if (!Open('{')) return false;
    for (Skip(); at_ < text_.size() && text_[at_] == '"'; Skip()) {
      const std::size_t here = at_;
      if (String() == name) {
        key_at = here;
        Skip();
        return true;
      }
      SkipValue();
    }
    return false;
  }
  bool EnterElement(std::size_t index) {
    if (!Open('[')) return false;
    for (; index > 0; --index) SkipValue();
    Skip();
    return at_ < text_.size() && text_[at_] != ']';
  }

  std::string_view text_;
  std::size_t at_ = 0;
};

/// An input iterator for the JSON parser that counts lines.
class LineCounter {
 public:
  using iterator_category = std::input_iterator_tag;
  using value_type = char;
  using difference_type = std::ptrdiff_t;
  using pointer = const char*;
  using reference = const char&;
  LineCounter(const char* at, std::size_t* line) : at_(at), line_(line) {}
  reference operator*() const { return *at_; }
  LineCounter& operator++() {
    if (*at_++ == '\n') ++*line_;
    return *this;
  }
  bool operator==(const LineCounter& other) const { return at_ == other.at_; }

 private:
  const char* at_;
  std::size_t* line_;
};

/// Refuses an object with the same key twice, of which nlohmann-json would silently keep the last,
/// and what is nested so deeply that writing it out again would need more stack than there is.
class StructureCheck {
 public:
  static constexpr int kMaxDepth = 64;
  bool operator()(int depth, json::parse_event_t event, json& parsed) {
    if (depth > kMaxDepth)
      throw ConfigFault{"(here)",
                        "more than " + std::to_string(kMaxDepth) + " brackets in each other"};
    const auto level = static_cast<std::size_t>(depth);
    if (event == json::parse_event_t::object_start) {
      seen_.resize(level + 1);
      seen_[level].clear();
    } else if (event == json::parse_event_t::key) {
      if (!seen_[level - 1].insert(parsed.get<std::string>()).second) {
        throw ConfigFault{parsed.get<std::string>(), "this key is written twice"};
      }
    }
    return true;
  }

 private:
  std::vector<std::set<std::string>> seen_;
};

}  // namespace

json ParseJson(std::string_view text, const std::string& origin) {
  std::size_t line = 1;
  try {
    const char* const end = text.data() + text.size();
    return json::parse(LineCounter(text.data(), &line), LineCounter(end, &line), StructureCheck(),
                       true, true);
  } catch (const ConfigFault& fault) {
    throw ConfigFault{
        "", origin + " line " + std::to_string(line) + ": " + fault.key + ": " + fault.text};
  } catch (const json::parse_error& error) {
    const std::string what = error.what();
    const std::size_t colon = what.find(": ");
    throw ConfigFault{
        "", origin + " line " + std::to_string(LineAt(text, error.byte > 0 ? error.byte - 1 : 0)) +
                ": not JSON: " + (colon == std::string::npos ? what : what.substr(colon + 2))};
  } catch (const json::exception& error) {  // for example a number out of range
    throw ConfigFault{"", origin + " line " + std::to_string(line) + ": not JSON: " + error.what()};
  }
}

std::size_t LineOfKey(std::string_view text, std::string_view key) {
  return KeyLocator(text).LineOf(key);
}

}  // namespace am
