#include "ssm/voice/text_tags.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <utility>

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

bool IsBlank(char c) { return c == ' ' || c == '\t'; }
bool IsNameByte(char c) { return (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9'); }

/// A tag at the beginning of `text`, which begins with '<'; none if it is not one of ours.
std::optional<Tag> ReadTag(std::string_view text) {
  Tag tag;
  std::size_t at = 1;
  const auto skip = [&] {
    while (at < text.size() && IsBlank(text[at])) ++at;
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
          Apply(*tag);
          at += tag->length;
          continue;
        }
      }
      at += Character(text.substr(at));
    }
    Cut();
    if (pause_.count() > 0 || !mark_.empty()) {  // at the very end: they need a span to stand in
      Begin();
      result_.spans.push_back(std::move(span_));
    }
    return std::move(result_);
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
          span_.text += sign;
          result_.plain += sign;
          return entity.size();
        }
      }
    }
    span_.text += rest[0];
    result_.plain += rest[0];
    return 1;
  }

  void Apply(const Tag& tag) {
    if (tag.closing) return Close(tag.name);
    if (tag.name == "SILENCE") {
      Cut();
      if (const auto ms = tag.Number("MSEC", 0, 60000)) {
        pause_ = std::min(pause_ + Millis(std::lround(*ms)), Millis{60000});
      }
      return;
    }
    if (tag.name == "BOOKMARK") {
      Cut();
      // Two marks with nothing between them need a span each.
      if (!mark_.empty()) {
        Begin();
        result_.spans.push_back(std::exchange(span_, Manner()));
      }
      if (auto name = tag.Attribute("MARK")) mark_ = std::move(*name);
      return;
    }
    if (tag.name != "RATE" && tag.name != "VOLUME" && tag.name != "PITCH" && tag.name != "VOICE")
      return;
    Cut();
    if (!tag.alone) open_.push_back({tag.name, Manner()});
    if (const auto speed = tag.Number("SPEED", 0.2, 5); speed && tag.name == "RATE") {
      span_.stretch *= *speed;
    }
    if (const auto level = tag.Number("LEVEL", 0.01, 4); level && tag.name == "VOLUME") {
      span_.volume *= *level;
    }
    if (const auto level = tag.Number("LEVEL", 0.5, 2); level && tag.name == "PITCH") {
      span_.pitch *= *level;
    }
    if (auto voice = tag.Attribute("OPTIONAL"); voice && tag.name == "VOICE") {
      span_.voice = std::move(*voice);
    }
  }

  void Close(const std::string& name) {
    for (auto open = open_.rbegin(); open != open_.rend(); ++open) {
      if (open->name != name) continue;
      Cut();
      span_ = open->before;
      open_.erase(std::next(open).base(), open_.end());
      return;
    }
  }

  /// The manner now in force, without text.
  SpeechSpan Manner() const {
    SpeechSpan manner = span_;
    manner.text.clear();
    manner.pause_before = Millis{0};
    manner.mark.clear();
    return manner;
  }
  void Begin() {
    span_.pause_before = std::exchange(pause_, Millis{0});
    span_.mark = std::exchange(mark_, {});
  }
  /// Ends the present span if it has text.
  void Cut() {
    if (span_.text.empty()) return;
    const SpeechSpan manner = Manner();
    Begin();
    result_.spans.push_back(std::exchange(span_, manner));
  }

  TaggedText result_;
  SpeechSpan span_;
  Millis pause_{0};
  std::string mark_;
  std::vector<Open> open_;
};

}  // namespace

TaggedText ParseTaggedText(std::string_view text) { return Parser().Parse(text); }

}  // namespace ssm
