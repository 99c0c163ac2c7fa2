#include "ssm/voice/text_tags.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <utility>

#include "ssm/voice/span_builder.h"
#include "vm_protocol/core/blanks.h"

namespace ssm {
namespace {

constexpr std::array<std::string_view, 17> kTags = {
    "SILENCE", "RATE",    "VOLUME", "PITCH", "VOICE",    "BOOKMARK", "EMPH",    "SPELL", "PRON",
    "SPEECH",  "CONTEXT", "APB",    "LANG",  "PARTOFSP", "RESET",    "REGWORD", "W1"};
constexpr std::array<std::pair<std::string_view, char>, 4> kEntities = {
    {{"&lt;", '<'}, {"&gt;", '>'}, {"&amp;", '&'}, {"&quot;", '"'}}};

struct Tag {
  std::string name;
  std::vector<std::pair<std::string, std::string>> attributes;
  bool closing = false;
  bool alone = false;  // <X/>
  std::size_t length = 0;

  std::optional<std::string> Attribute(std::string_view wanted) const {
    for (const auto& [key, value] : attributes) {
      if (key == wanted) return value;
    }
    return std::nullopt;
  }
  std::optional<double> Number(std::string_view wanted, double least, double most) const {
    const auto text = Attribute(wanted);
    if (!text) return std::nullopt;
    char* end = nullptr;
    const double number = std::strtod(text->c_str(), &end);
    if (end == text->c_str() || *end != '\0' || !std::isfinite(number)) return std::nullopt;
    return std::clamp(number, least, most);
  }
};

bool IsNameByte(char c) { return (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9'); }

/// A tag at the beginning of `text`, which begins with '<'; none if it is not one of ours.
std::optional<Tag> ReadTag(std::string_view text) {
  Tag tag;
  std::size_t at = 1;
  const auto skip = [&] {
    while (at < text.size() && vm::IsBlank(text[at])) ++at;
  };
  const auto name = [&] {
    const std::size_t begin = at;
    while (at < text.size() && IsNameByte(text[at])) ++at;
    return std::string(text.substr(begin, at - begin));
  };
  if (at < text.size() && text[at] == '/') {
    tag.closing = true;
    ++at;
  }
  tag.name = name();
  if (std::find(kTags.begin(), kTags.end(), tag.name) == kTags.end()) return std::nullopt;
  while (true) {
    skip();
    if (at >= text.size()) return std::nullopt;
    if (text[at] == '>') break;
    if (text[at] == '/') {
      tag.alone = true;
      ++at;
      continue;
    }
    std::string key = name();
    skip();
    if (key.empty() || at >= text.size() || text[at] != '=') return std::nullopt;
    ++at;
    skip();
    if (at >= text.size() || text[at] != '"') return std::nullopt;
    const std::size_t end = text.find('"', at + 1);
    if (end == std::string_view::npos) return std::nullopt;
    tag.attributes.emplace_back(std::move(key), text.substr(at + 1, end - at - 1));
    at = end + 1;
  }
  tag.length = at + 1;
  return tag;
}

class Parser {
 public:
  TaggedText Parse(std::string_view text) {
    for (std::size_t at = 0; at < text.size();) {
      if (text[at] == '<') {
        if (const auto tag = ReadTag(text.substr(at))) {
          at += tag->length;
          if (!Replace(*tag, text, at)) Apply(*tag);
          continue;
        }
      }
      at += Character(text.substr(at));
    }
    return builder_.Finish();
  }

 private:
  struct Open {
    std::string name;
    SpeechSpan before;
  };

  std::size_t Character(std::string_view rest) {
    if (rest[0] == '&') {
      for (const auto& [entity, sign] : kEntities) {
        if (rest.starts_with(entity)) {
          builder_.Text(std::string_view(&sign, 1));
          return entity.size();
        }
      }
    }
    builder_.Text(rest.substr(0, 1));
    return 1;
  }

  /// Tags whose text is spoken in another way: SPELL, PRON, CONTEXT. `at` is behind the tag, and
  /// moves behind its end. What they hold must be plain text, else they change nothing.
  bool Replace(const Tag& tag, std::string_view text, std::size_t& at) {
    if (tag.closing || tag.alone) return false;
    if (tag.name != "SPELL" && tag.name != "PRON" && tag.name != "CONTEXT") return false;
    const std::string close = "</" + tag.name + ">";
    const std::size_t end = text.find(close, at);
    if (end == std::string_view::npos) return false;
    const std::string_view inside = text.substr(at, end - at);
    if (inside.contains('<') || inside.contains('&')) return false;
    const std::string spoken = Spoken(tag, inside);
    if (spoken.empty()) return false;
    builder_.Text(inside, spoken);
    at = end + close.size();
    return true;
  }

  static std::string Spoken(const Tag& tag, std::string_view inside) {
    if (tag.name == "SPELL") return SpellOut(inside);
    if (tag.name == "PRON") {
      const std::string reading = tag.Attribute("SYM").value_or("");
      return IsKanaReading(reading) ? WithoutAccent(reading) : std::string();
    }
    const std::string type = tag.Attribute("TYPE").value_or("");
    return type == "DIGITS" || type == "PHONE" ? SpacedDigits(inside) : std::string();
  }

  void Apply(const Tag& tag) {
    if (tag.closing) return Close(tag.name);
    if (tag.name == "SILENCE") {
      const auto ms = tag.Number("MSEC", 0, 60000);
      return builder_.Pause(Millis(ms ? std::lround(*ms) : 0));
    }
    if (tag.name == "BOOKMARK") {
      if (auto name = tag.Attribute("MARK")) builder_.Mark(*name);
      return;
    }
    if (tag.name == "RESET") {
      if (!open_.empty()) builder_.SetManner(open_.front().before);
      return open_.clear();
    }
    if (tag.name != "RATE" && tag.name != "VOLUME" && tag.name != "PITCH" && tag.name != "VOICE" &&
        tag.name != "EMPH") {
      return;
    }
    SpeechSpan manner = builder_.manner();
    if (!tag.alone) {
      open_.push_back({tag.name, manner});
      ++manner.depth;
    }
    if (tag.name == "EMPH" && !tag.alone) Emphasize(manner, 1);
    if (const auto speed = tag.Number("SPEED", 0.2, 5); speed && tag.name == "RATE") {
      manner.stretch *= *speed;
    }
    if (const auto level = tag.Number("LEVEL", 0.01, 4); level && tag.name == "VOLUME") {
      manner.volume *= *level;
    }
    if (const auto level = tag.Number("LEVEL", 0.5, 2); level && tag.name == "PITCH") {
      manner.pitch *= *level;
    }
    if (auto voice = tag.Attribute("OPTIONAL"); voice && tag.name == "VOICE") {
      manner.voice = std::move(*voice);
    }
    builder_.SetManner(std::move(manner));
  }

  void Close(const std::string& name) {
    for (auto open = open_.rbegin(); open != open_.rend(); ++open) {
      if (open->name != name) continue;
      builder_.SetManner(open->before);
      open_.erase(std::next(open).base(), open_.end());
      return;
    }
  }

  SpanBuilder builder_;
  std::vector<Open> open_;
};

}  // namespace

TaggedText ParseTaggedText(std::string_view text) { return Parser().Parse(text); }

}  // namespace ssm
