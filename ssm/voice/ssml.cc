#include "ssm/voice/ssml.h"

#include <tinyxml2.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <string>
#include <utility>

#include "ssm/voice/pronounced_text.h"
#include "ssm/voice/span_builder.h"

namespace ssm {
namespace {

using tinyxml2::XMLElement;
using tinyxml2::XMLNode;

constexpr int kMaxDepth = 64;

struct Named {
  std::string_view name;
  double factor;
};
// The words of the standard; their values are left to the implementation.
constexpr std::array<Named, 7> kRates = {{{"x-slow", 0.5},
                                          {"slow", 0.75},
                                          {"medium", 1},
                                          {"fast", 1.35},
                                          {"x-fast", 1.8},
                                          {"default", 1},
                                          {"", 1}}};
constexpr std::array<Named, 7> kPitches = {{{"x-low", 0.7},
                                            {"low", 0.85},
                                            {"medium", 1},
                                            {"high", 1.18},
                                            {"x-high", 1.4},
                                            {"default", 1},
                                            {"", 1}}};
constexpr std::array<Named, 8> kVolumes = {{{"silent", 0},
                                            {"x-soft", 0.25},
                                            {"soft", 0.5},
                                            {"medium", 1},
                                            {"loud", 1.6},
                                            {"x-loud", 2.5},
                                            {"default", 1},
                                            {"", 1}}};
constexpr std::array<Named, 6> kBreaks = {{{"none", 0},
                                           {"x-weak", 50},
                                           {"weak", 150},
                                           {"medium", 300},
                                           {"strong", 600},
                                           {"x-strong", 1000}}};

template <std::size_t N>
std::optional<double> Lookup(const std::array<Named, N>& table, std::string_view name) {
  for (const Named& row : table) {
    if (row.name == name) return row.factor;
  }
  return std::nullopt;
}

/// "120%" and "1.2" are factors, "+20%" is added to one, "+6dB" and "+2st" are relative.
std::optional<double> Factor(const std::string& text) {
  char* rest = nullptr;
  const double number = std::strtod(text.c_str(), &rest);
  if (rest == text.c_str() || !std::isfinite(number)) return std::nullopt;
  const std::string_view unit = rest;
  const bool relative = text[0] == '+' || text[0] == '-';
  if (unit == "%") return relative ? 1 + number / 100 : number / 100;
  if (unit == "dB") return std::pow(10, number / 20);
  if (unit == "st") return std::pow(2, number / 12);
  if (unit.empty() && !relative) return number;
  return std::nullopt;
}

std::optional<Millis> Duration(const std::string& text) {
  char* rest = nullptr;
  const double number = std::strtod(text.c_str(), &rest);
  if (rest == text.c_str() || !std::isfinite(number)) return std::nullopt;
  const std::string_view unit = rest;
  if (unit != "s" && unit != "ms") return std::nullopt;
  const double ms = unit == "s" ? number * 1000 : number;
  return Millis(std::lround(std::clamp(ms, 0.0, 60'000.0)));
}

std::string Attribute(const XMLElement& element, const char* name) {
  const char* value = element.Attribute(name);
  return value == nullptr ? "" : value;
}

class Reader {
 public:
  vm::Result<TaggedText> Read(const XMLElement& root) {
    Children(root, 0);
    if (!error_.text.empty()) return std::unexpected(error_);
    return builder_.Finish();
  }

 private:
  void Children(const XMLElement& element, int depth) {
    if (depth > kMaxDepth) {
      error_ = {vm::Errc::kSyntax,
                "line " + std::to_string(element.GetLineNum()) + ": elements are nested too deep",
                0};
      return;
    }
    for (const XMLNode* child = element.FirstChild(); child != nullptr && error_.text.empty();
         child = child->NextSibling()) {
      if (child->ToText() != nullptr) {
        Text(child->Value());
      } else if (const XMLElement* inner = child->ToElement()) {
        Element(*inner, depth + 1);
      }
    }
  }

  /// Line ends and runs of blanks in a document are one blank.
  void Text(std::string_view text) {
    for (const char c : text) {
      const bool blank = c == ' ' || c == '\n' || c == '\t' || c == '\r';
      if (!blank)
        builder_.Text(std::string_view(&c, 1));
      else if (!blank_)
        builder_.Text(" ");
      blank_ = blank;
    }
  }

  void Element(const XMLElement& element, int depth) {
    const std::string_view name = element.Name();
    if (name == "break") return Break(element);
    if (name == "mark") return builder_.Mark(Attribute(element, "name"));
    if (name == "sub" && element.Attribute("alias")) return Text(Attribute(element, "alias"));
    if (name == "metadata" || name == "meta" || name == "lexicon") return;
    if (name == "p" || name == "s") return Paragraph(element, name == "p" ? 400 : 200, depth);
    if (name == "audio" && element.Attribute("src"))
      return builder_.Audio(Attribute(element, "src"));
    if (name == "phoneme" && Phoneme(element)) return;
    if (name == "say-as") return SayAs(element, depth);
    const SpeechSpan before = builder_.manner();
    SpeechSpan manner = before;
    if (name == "prosody") Prosody(element, manner);
    if (name == "emphasis") Emphasis(Attribute(element, "level"), manner);
    if (name == "voice" && element.Attribute("name")) manner.voice = Attribute(element, "name");
    builder_.SetManner(manner);
    Children(element, depth);
    builder_.SetManner(before);
  }

  /// False if its pronunciation cannot be read: then what it holds is spoken.
  bool Phoneme(const XMLElement& element) {
    const std::string ph = Attribute(element, "ph"), alphabet = Attribute(element, "alphabet");
    const char* text = element.GetText();
    if (IsKanaReading(ph)) {
      Text(ph);
      return true;
    }
    vm::Result<std::string> ipa = ph;
    if (alphabet == "x-sampa") ipa = IpaOfSampa(ph);
    if (alphabet == "x-arpabet" || alphabet == "x-cmu") ipa = IpaOfArpabet(ph);
    if (!ipa || !IpaForFlite(*ipa) || text == nullptr) return false;
    builder_.Text(text, Pronounced(*ipa, text));
    blank_ = false;
    return true;
  }

  void Break(const XMLElement& element) {
    const auto time = Duration(Attribute(element, "time"));
    const auto strength = Lookup(kBreaks, Attribute(element, "strength"));
    builder_.Pause(time ? *time : Millis(static_cast<std::int64_t>(strength.value_or(300))));
  }

  void Paragraph(const XMLElement& element, int pause_ms, int depth) {
    if (builder_.has_text()) builder_.Pause(Millis(pause_ms));
    blank_ = true;
    Children(element, depth);
    builder_.SetManner(builder_.manner());  // what follows is another sentence
  }

  void SayAs(const XMLElement& element, int depth) {
    const std::string how = Attribute(element, "interpret-as");
    const char* text = element.GetText();
    if (text != nullptr && (how == "characters" || how == "spell-out")) return Text(SpellOut(text));
    if (text != nullptr && (how == "digits" || how == "telephone")) return Text(SpacedDigits(text));
    Children(element, depth);
  }

  static void Prosody(const XMLElement& element, SpeechSpan& manner) {
    const auto value = [&](const char* name, const auto& table, double least, double most) {
      const std::string text = Attribute(element, name);
      auto factor = Lookup(table, text);
      if (!factor) factor = Factor(text);
      return std::clamp(factor.value_or(1), least, most);
    };
    manner.stretch /= value("rate", kRates, 0.2, 5);
    manner.pitch *= value("pitch", kPitches, 0.5, 2);
    manner.volume *= value("volume", kVolumes, 0, 4);
  }

  static void Emphasis(const std::string& level, SpeechSpan& manner) {
    if (level == "none") return;
    const double amount = level == "strong" ? 1.5 : level == "reduced" ? -1 : 1;
    Emphasize(manner, amount);
  }

  SpanBuilder builder_;
  bool blank_ = true;
  vm::Error error_{};
};

}  // namespace

bool IsSsml(std::string_view text) {
  std::size_t at = text.find_first_not_of(" \t\r\n");
  if (at != std::string_view::npos && text.substr(at).starts_with("<?xml")) {
    at = text.find("?>", at);
    if (at != std::string_view::npos) at = text.find_first_not_of(" \t\r\n", at + 2);
  }
  if (at == std::string_view::npos || !text.substr(at).starts_with("<speak")) return false;
  const std::string_view rest = text.substr(at + 6);
  return !rest.empty() && std::strchr(" \t\r\n/>", rest[0]) != nullptr;
}

vm::Result<TaggedText> ParseSsml(std::string_view text) {
  if (text.find("<!ENTITY") != std::string_view::npos) {
    return vm::Fail(vm::Errc::kSyntax, "SSML with ENTITY declarations is not read");
  }
  tinyxml2::XMLDocument document(true, tinyxml2::PRESERVE_WHITESPACE);
  if (document.Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS) {
    return vm::Fail(vm::Errc::kSyntax,
                    "SSML line " + std::to_string(document.ErrorLineNum()) +
                        ": the XML is broken (" +
                        tinyxml2::XMLDocument::ErrorIDToName(document.ErrorID()) + ")");
  }
  return Reader().Read(*document.RootElement());
}

vm::Result<TaggedText> ReadMarkup(std::string_view raw) {
  const std::string text = WithoutPronunciationMarks(raw);
  if (IsSsml(text)) return ParseSsml(text);
  return ParseTaggedText(text);
}

}  // namespace ssm
