#include "ssm/voice/ssml.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "ssm/voice/lexicon.h"
#include "ssm/voice/pronounced_text.h"
#include "ssm/voice/span_builder.h"
#include "ssm/voice/spoken_forms.h"
#include "ssm/voice/text_flow.h"
#include "vm_protocol/xml/parser.h"

namespace ssm {
namespace {

using vm::xml::Node;

constexpr std::size_t kMaxDepth = 64;
constexpr std::size_t kMaxLexicons = 8;
constexpr std::size_t kMaxTargets = 100;
constexpr Millis kLongest{60'000};

struct Named {
  std::string_view name;
  double value;
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
constexpr std::array<Named, 7> kRanges = {{{"x-low", 0.4},
                                           {"low", 0.7},
                                           {"medium", 1},
                                           {"high", 1.4},
                                           {"x-high", 1.8},
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
    if (row.name == name) return row.value;
  }
  return std::nullopt;
}

struct Quantity {
  double number = 0;
  std::string unit{};
  bool relative = false;  ///< written with a sign
};
std::optional<Quantity> ReadQuantity(const std::string& text) {
  char* rest = nullptr;
  const double number = std::strtod(text.c_str(), &rest);
  if (rest == text.c_str() || !std::isfinite(number)) return std::nullopt;
  return Quantity{number, std::string(vm::xml::Trim(rest)), text[0] == '+' || text[0] == '-'};
}

std::optional<Millis> Duration(const std::string& text) {
  const auto read = ReadQuantity(text);
  if (!read || (read->unit != "s" && read->unit != "ms")) return std::nullopt;
  const double ms = read->unit == "s" ? read->number * 1000 : read->number;
  return Millis(std::lround(std::clamp(ms, 0.0, static_cast<double>(kLongest.count()))));
}

/// "120%" and "1.2" are factors, "+20%" is added to one.
std::optional<double> RateFactor(const Quantity& rate) {
  if (rate.unit == "%") return rate.relative ? 1 + rate.number / 100 : rate.number / 100;
  if (rate.unit.empty() && !rate.relative) return rate.number;
  return std::nullopt;
}
/// 0 to 100 (SSML 1.0), changes of that, percent, dB.
std::optional<double> VolumeFactor(const Quantity& volume) {
  if (volume.unit == "dB") return std::pow(10, volume.number / 20);
  if (volume.unit != "%" && !volume.unit.empty()) return std::nullopt;
  return volume.relative ? 1 + volume.number / 100 : volume.number / 100;
}
std::optional<double> PitchFactor(const Quantity& pitch) {
  if (pitch.unit == "st") return std::pow(2, pitch.number / 12);
  return RateFactor(pitch);
}

/// "(0%,+20Hz) (50%,+10%)"
std::optional<std::vector<Intonation::Target>> ReadContour(std::string_view text) {
  std::vector<Intonation::Target> contour;
  while (!vm::xml::IsBlank(text)) {
    text = vm::xml::Trim(text);
    const std::size_t comma = text.find(','), end = text.find(')');
    if (text[0] != '(' || end == text.npos || comma > end || contour.size() >= kMaxTargets) {
      return std::nullopt;
    }
    const auto place = ReadQuantity(std::string(vm::xml::Trim(text.substr(1, comma - 1))));
    const auto pitch =
        ReadQuantity(std::string(vm::xml::Trim(text.substr(comma + 1, end - comma - 1))));
    if (!place || place->unit != "%" || !pitch) return std::nullopt;
    Intonation::Target target{.at01 = std::clamp(place->number / 100, 0.0, 1.0)};
    if (pitch->unit == "Hz") {
      (pitch->relative ? target.shift_hz : target.hz) = pitch->number;
    } else if (const auto factor = PitchFactor(*pitch)) {
      target.factor = *factor;
    } else {
      return std::nullopt;
    }
    if (contour.empty() || target.at01 > contour.back().at01) contour.push_back(target);
    text.remove_prefix(end + 1);
  }
  return contour;
}

class Reader {
 public:
  explicit Reader(const MarkupOptions& options) : options_(options) {}

  TaggedText Read(const Node& root) {
    everywhere_ = root.Get("version") == "1.0";  // lexicons count without <lookup>
    for (const char* part : {"startmark", "endmark"}) {
      if (root.Has(part)) Note(std::string(part) + " of <speak> is not obeyed");
    }
    language_ = root.Get("xml:lang", options_.language);
    Children(root);
    return builder_.Finish();
  }

 private:
  void Note(const std::string& what) { builder_.Note("SSML: " + what); }
  void NoteValue(const Node& element, const char* attribute) {
    Note("<" + element.name + " " + attribute + "=\"" + element.Get(attribute).substr(0, 60) +
         "\"> is not understood");
  }

  void Children(const Node& element) {
    for (const auto& child : element.children) {
      if (child->IsText()) {
        Text(child->text);
      } else if (child->IsElement()) {
        Element(*child);
      }
    }
  }

  /// Line ends and runs of blanks in a document are one blank.
  void Text(std::string_view text) {
    constexpr std::string_view kBlanks = " \n\t\r";
    for (std::size_t at = 0; at < text.size();) {
      if (kBlanks.contains(text[at])) {
        flow_.Blank();
        at = std::min(text.find_first_not_of(kBlanks, at), text.size());
        continue;
      }
      // A word, or what there is of it before one of a lexicon.
      std::size_t end = at;
      const Lexicon::Entry* entry = nullptr;
      while (end < text.size() && !kBlanks.contains(text[end])) {
        entry = Known(text, end);
        if (entry != nullptr) break;
        ++end;
      }
      flow_.Say(text.substr(at, end - at));
      at = end;
      if (entry == nullptr) continue;
      const std::string& word = entry->grapheme;
      flow_.Say(word, entry->alias.empty() ? Pronunciation(entry->ipa, word) : entry->alias);
      at += word.size();
    }
  }

  /// The word of a lexicon that stands there; null if there is none.
  const Lexicon::Entry* Known(std::string_view text, std::size_t at) const {
    for (auto lexicon = active_.rbegin(); lexicon != active_.rend(); ++lexicon) {
      if (const Lexicon::Entry* entry = (*lexicon)->Find(text, at)) return entry;
    }
    return nullptr;
  }

  /// All elements but marks and pauses of no length end the word before them.
  void Element(const Node& element) {
    const std::string& name = element.name;
    if (name == "mark") return builder_.Mark(element.Get("name"));
    if (name == "break") return Break(element);
    const bool token = name == "token" || name == "w";
    token ? flow_.OpenToken() : flow_.Edge();
    Inside(element);
    token ? flow_.CloseToken() : flow_.Edge();
  }

  void Inside(const Node& element) {
    const std::string& name = element.name;
    if (name == "metadata" || name == "meta" || name == "desc") return;
    if (name == "lexicon") return LoadLexicon(element);
    if (name == "audio" && Audio(element)) return;
    const SpeechSpan before = builder_.manner();
    const std::string language_before = language_;
    SpeechSpan manner = before;
    if (const std::string* language = element.Find("xml:lang")) {
      manner.language = language_ = *language;
    }
    if (name == "prosody") Prosody(element, manner);
    if (name == "emphasis") Emphasis(element, manner);
    if (name == "voice") Voice(element, manner);
    if (name == "prosody" || name == "emphasis" || name == "voice") ++manner.depth;
    builder_.SetManner(manner);
    Content(element);
    builder_.SetManner(before);
    language_ = language_before;
  }

  void Content(const Node& element) {
    const std::string& name = element.name;
    if (name == "sub" && element.Has("alias")) return Text(element.Get("alias"));
    if (name == "phoneme" && Phoneme(element)) return;
    if (name == "say-as" && SayAs(element)) return;
    if (name == "lookup") return Looked(element);
    if (name == "p" || name == "s") return Paragraph(element, name == "p" ? 400 : 200);
    Children(element);
  }

  std::string Pronunciation(const std::string& ipa, const std::string& written) {
    if (IsKanaReading(ipa)) return ipa;
    return IpaForFlite(ipa) ? Pronounced(ipa, written) : written;
  }

  /// False if its pronunciation cannot be read: then what it holds is spoken.
  bool Phoneme(const Node& element) {
    const std::string ph = element.Get("ph"), alphabet = element.Get("alphabet");
    const std::string text = vm::xml::Collapse(element.Text());
    if (IsKanaReading(ph)) {
      flow_.Say(text.empty() ? ph : text, ph);
      return true;
    }
    vm::Result<std::string> ipa = ph;
    if (alphabet == "x-sampa") ipa = IpaOfSampa(ph);
    if (alphabet == "x-arpabet" || alphabet == "x-cmu") ipa = IpaOfArpabet(ph);
    if (!ipa || !IpaForFlite(*ipa)) {
      NoteValue(element, "ph");
      return false;
    }
    const std::string written = text.empty() ? ph : text;
    flow_.Say(written, Pronounced(*ipa, written));
    return true;
  }

  void Break(const Node& element) {
    const std::string strength = element.Get("strength", "medium");
    auto time = Duration(element.Get("time"));
    if (element.Has("time") && !time) NoteValue(element, "time");
    const auto named = Lookup(kBreaks, strength);
    if (!named) NoteValue(element, "strength");
    const Millis length = time ? *time : Millis(static_cast<std::int64_t>(named.value_or(300)));
    if (length.count() > 0) flow_.Edge();
    builder_.Pause(length);
  }

  void Paragraph(const Node& element, int pause_ms) {
    if (builder_.has_text()) builder_.Pause(Millis(pause_ms));
    flow_.SentenceEdge();
    Children(element);
    flow_.SentenceEdge();
  }

  bool SayAs(const Node& element) {
    const std::string how = element.Get("interpret-as"), text = element.Text();
    auto spoken = SpokenForm(how, element.Get("format"), text, language_);
    if (!spoken) {
      if (!vm::xml::IsBlank(text)) NoteValue(element, "interpret-as");
      return false;
    }
    flow_.Say(vm::xml::Collapse(text), *spoken);
    return true;
  }

  void LoadLexicon(const Node& element) {
    const std::string uri = element.Get("uri");
    if (lexicons_.size() >= kMaxLexicons) {
      return Note("more than " + std::to_string(kMaxLexicons) + " lexicons");
    }
    if (!options_.read_file) return NoteValue(element, "uri");
    auto bytes = options_.read_file(uri);
    if (!bytes) return Note("lexicon: " + bytes.error().text);
    auto lexicon = Lexicon::Parse(*bytes, uri);
    if (!lexicon) return Note("lexicon " + lexicon.error().text);
    const auto [at, is_new] = lexicons_.emplace(element.Get("xml:id", uri), std::move(*lexicon));
    if (is_new && everywhere_) active_.push_back(&at->second);
  }

  void Looked(const Node& element) {
    const auto found = lexicons_.find(element.Get("ref"));
    if (found == lexicons_.end()) {
      NoteValue(element, "ref");
      return Children(element);
    }
    active_.push_back(&found->second);
    Children(element);
    active_.pop_back();
  }

  /// False if the file cannot be played: then what the element holds is spoken.
  bool Audio(const Node& element) {
    std::string path = element.Get("src");
    if (path.starts_with("file://")) path.erase(0, 7);
    if (path.empty() || (options_.is_sound && !options_.is_sound(path))) {
      if (!path.empty()) Note("'" + path.substr(0, 200) + "' cannot be played");
      return false;
    }
    SpeechSpan::Clip clip;
    clip.begin = Duration(element.Get("clipBegin")).value_or(Millis{0});
    clip.end = Duration(element.Get("clipEnd")).value_or(Millis{0});
    clip.most = Duration(element.Get("repeatDur")).value_or(Millis{0});
    if (const auto count = ReadQuantity(element.Get("repeatCount"))) {
      clip.repeats = std::clamp(count->number, 0.0, 1000.0);
    } else if (clip.most.count() > 0) {
      clip.repeats = 1000;
    }
    if (const auto speed = ReadQuantity(element.Get("speed"))) {
      clip.speed = std::clamp(RateFactor(*speed).value_or(1), 0.25, 4.0);
    }
    double volume = 1;
    if (const auto level = ReadQuantity(element.Get("soundLevel"))) {
      volume = std::clamp(VolumeFactor(*level).value_or(1), 0.0, 4.0);
    }
    builder_.Audio(path, clip, volume);
    return true;
  }

  void Voice(const Node& element, SpeechSpan& manner) {
    if (element.Has("name")) manner.voice = element.Get("name");
    const std::string gender = element.Get("gender");
    if (gender == "male" || gender == "female") {
      manner.gender = gender;
      if (!element.Has("name")) manner.voice.clear();
    } else if (!gender.empty() && gender != "neutral") {
      NoteValue(element, "gender");
    }
    if (element.Has("age")) Note("no voice here has an age; <voice age> is not obeyed");
    if (element.Has("languages") && !element.Has("xml:lang")) {
      const std::string first = element.Get("languages");
      manner.language = language_ = first.substr(0, first.find_first_of(" :"));
    }
  }

  /// The attribute's value by its table, else by `read` of a number with a unit.
  template <typename Table, typename Convert>
  double Value(const Node& element, const char* name, const Table& table, Convert convert,
               double least, double most) {
    const std::string text(vm::xml::Trim(element.Get(name)));
    auto value = Lookup(table, text);
    if (const auto quantity = ReadQuantity(text); !value && quantity) value = convert(*quantity);
    if (!value) NoteValue(element, name);
    return std::clamp(value.value_or(1), least, most);
  }

  void Prosody(const Node& element, SpeechSpan& manner) {
    manner.stretch /= Value(element, "rate", kRates, RateFactor, 0.2, 5);
    manner.volume *= Value(element, "volume", kVolumes, VolumeFactor, 0, 4);
    Intonation& tone = manner.intonation;
    const auto pitch = ReadQuantity(std::string(vm::xml::Trim(element.Get("pitch"))));
    if (pitch && pitch->unit == "Hz") {
      (pitch->relative ? tone.shift_hz : tone.hz) = std::clamp(pitch->number, -400.0, 800.0);
    } else {
      const double factor = Value(element, "pitch", kPitches, PitchFactor, 0.5, 2);
      manner.pitch *= factor;
      tone.hz *= factor;
    }
    tone.range *= Value(element, "range", kRanges, PitchFactor, 0.1, 4);
    if (element.Has("contour")) {
      if (auto contour = ReadContour(element.Get("contour"))) {
        tone.contour = std::move(*contour);
        manner.element = ++elements_;
      } else {
        NoteValue(element, "contour");
      }
    }
    if (element.Has("duration")) {
      if (const auto lasts = Duration(element.Get("duration")); lasts && lasts->count() > 0) {
        manner.lasts = *lasts;
        manner.element = elements_ += element.Has("contour") ? 0 : 1;
      } else {
        NoteValue(element, "duration");
      }
    }
  }

  void Emphasis(const Node& element, SpeechSpan& manner) {
    const std::string level = element.Get("level", "moderate");
    if (level == "none") return;
    if (level != "strong" && level != "moderate" && level != "reduced") {
      return NoteValue(element, "level");
    }
    Emphasize(manner, level == "strong" ? 1.5 : level == "reduced" ? -1 : 1);
  }

  const MarkupOptions& options_;
  SpanBuilder builder_;
  TextFlow flow_{builder_};
  std::string language_;
  std::map<std::string, Lexicon> lexicons_;
  std::vector<const Lexicon*> active_;  ///< the innermost last
  bool everywhere_ = false;
  unsigned elements_ = 0;
};

}  // namespace

bool IsSsml(std::string_view text) {
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  const auto skip = [&text](std::string_view begin, std::string_view end) {
    if (!text.starts_with(begin)) return false;
    const std::size_t at = text.find(end, begin.size());
    text.remove_prefix(at == text.npos ? text.size() : at + end.size());
    return true;
  };
  while (true) {
    text = vm::xml::Trim(text);
    if (skip("<!--", "-->") || skip("<?", "?>")) continue;
    if (!text.starts_with("<!DOCTYPE")) break;
    const std::size_t subset = text.find_first_of("[>");
    const bool has_subset = subset != text.npos && text[subset] == '[';
    if (!skip("<!DOCTYPE", has_subset ? "]" : ">")) break;
    if (has_subset) skip("", ">");
  }
  if (!text.starts_with('<')) return false;
  std::string_view name = text.substr(1, text.find_first_of(" \t\r\n/>", 1) - 1);
  if (const std::size_t colon = name.find(':'); colon != name.npos) name.remove_prefix(colon + 1);
  return name == "speak";
}

vm::Result<TaggedText> ParseSsml(std::string_view text, const MarkupOptions& options) {
  vm::xml::Limits limits;
  limits.depth = kMaxDepth;
  const auto document = vm::xml::Parse(vm::xml::Trim(text), "SSML", "utf-8", limits);
  if (!document) return std::unexpected(document.error());
  return Reader(options).Read(*document->root);
}

vm::Result<TaggedText> ReadMarkup(std::string_view raw, const MarkupOptions& options) {
  const std::string text = WithoutPronunciationMarks(raw);
  if (IsSsml(text)) return ParseSsml(text, options);
  return ParseTaggedText(text);
}

}  // namespace ssm
