#include "ssm/voice/ssml.h"

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "ssm/voice/language_tag.h"
#include "ssm/voice/lexicon.h"
#include "ssm/voice/markup_uri.h"
#include "ssm/voice/pronounced_text.h"
#include "ssm/voice/span_builder.h"
#include "ssm/voice/spoken_forms.h"
#include "ssm/voice/ssml_values.h"
#include "ssm/voice/text_flow.h"
#include "vm_protocol/xml/parser.h"

namespace ssm {
namespace {

using vm::xml::Node;

constexpr std::size_t kMaxDepth = 64;
constexpr std::size_t kMaxLexicons = 8;
/// Of <phoneme>; readings in kana are known by their signs, whichever of these is named.
constexpr std::array<std::string_view, 7> kAlphabets = {"",      "ipa",    "x-sampa", "x-arpabet",
                                                        "x-cmu", "x-kana", "x-JEITA"};

constexpr std::array<std::string_view, 4> kLangFailures = {"changevoice", "ignoretext",
                                                           "ignorelang", "processorchoice"};

class Reader {
 public:
  explicit Reader(const MarkupOptions& options) : options_(options) {
    around_.language = options.language;
  }

  TaggedText Read(const Node& root) {
    everywhere_ = root.Get("version") == "1.0";  // lexicons count without <lookup>
    for (const char* part : {"startmark", "endmark"}) {
      if (root.Has(part)) Note(std::string(part) + " of <speak> is not obeyed");
    }
    Surround(root);
    Children(root);
    return builder_.Finish();
  }

 private:
  /// What an element has from those around it.
  struct Surroundings {
    std::string language{};
    std::string base{};             ///< what relative references are resolved against
    std::string on_lang_failure{};  ///< as the attribute says; empty = processorchoice
    bool left_out = false;          ///< text in a language that failed
  };

  void Note(const std::string& what) { values_.Note(what); }
  void NoteValue(const Node& element, const char* attribute) {
    values_.NoteUnknown(element, attribute);
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
    if (around_.left_out) return;
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
    if (name == "mark") return Mark(element);
    if (name == "break") return Break(element);
    const Surroundings outside = around_;
    const bool token = name == "token" || name == "w";
    token ? flow_.OpenToken() : flow_.Edge();
    Inside(element);
    token ? flow_.CloseToken() : flow_.Edge();
    around_ = outside;
  }

  /// Attributes that every element may have. True if its language is another one and is spoken.
  bool Surround(const Node& element) {
    around_.base = ResolveUri(around_.base, element.Get("xml:base"));
    if (const std::string* wish = element.Find("onlangfailure")) {
      if (std::ranges::find(kLangFailures, *wish) != kLangFailures.end()) {
        around_.on_lang_failure = *wish;
      } else {
        NoteValue(element, "onlangfailure");
      }
    }
    const std::string* language = element.Find("xml:lang");
    if (language == nullptr) return false;
    if (language->empty() || !options_.speaks || options_.speaks(PrimaryLanguage(*language))) {
      around_.language = *language;
      around_.left_out = false;
      return true;
    }
    const bool ignore_text = around_.on_lang_failure == "ignoretext";
    Note("no voice speaks '" + language->substr(0, 40) + "'; the text in it is " +
         (ignore_text ? "left out" : "read as what is around it"));
    if (ignore_text) around_.left_out = true;
    return false;
  }

  void Inside(const Node& element) {
    const std::string& name = element.name;
    if (name == "metadata" || name == "meta" || name == "desc") return;
    const bool other_language = Surround(element);
    if (name == "lexicon") return LoadLexicon(element);
    if (name == "audio" && Audio(element)) return;
    const SpeechSpan before = builder_.manner();
    SpeechSpan manner = before;
    if (other_language) manner.language = around_.language;
    if (name == "prosody") Prosody(element, manner);
    if (name == "emphasis") Emphasis(element, manner);
    if (name == "voice") Voice(element, manner);
    if (name == "prosody" || name == "emphasis" || name == "voice") ++manner.depth;
    builder_.SetManner(manner);
    Content(element);
    builder_.SetManner(before);
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

  void Say(std::string_view written, std::string_view spoken) {
    if (!around_.left_out) flow_.Say(written, spoken);
  }

  std::string Pronunciation(const std::string& ipa, const std::string& written) {
    if (IsKanaReading(ipa)) return ipa;
    return IpaForFlite(ipa) ? Pronounced(ipa, written) : written;
  }

  /// False if its pronunciation cannot be read: then what it holds is spoken.
  bool Phoneme(const Node& element) {
    const std::string ph = element.Get("ph"), alphabet = element.Get("alphabet");
    const std::string text = vm::xml::Collapse(element.Text());
    if (std::ranges::find(kAlphabets, alphabet) == kAlphabets.end()) {
      NoteValue(element, "alphabet");
      return false;
    }
    if (IsKanaReading(ph)) {
      Say(text.empty() ? ph : text, ph);
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
    Say(written, Pronounced(*ipa, written));
    return true;
  }

  void Break(const Node& element) {
    const auto time = values_.Time(element, "time", kLongestAsked);
    const auto named = Lookup(BreakNames(), element.Get("strength", "medium"));
    if (!named) NoteValue(element, "strength");
    const Millis length = time ? *time : Millis(static_cast<std::int64_t>(named.value_or(300)));
    if (length.count() > 0) flow_.Edge();
    builder_.Pause(length);
  }

  void Mark(const Node& element) {
    if (element.Get("name").empty()) return Note("<mark> without a name is left out");
    builder_.Mark(element.Get("name"));
  }

  void Paragraph(const Node& element, int pause_ms) {
    if (builder_.has_text()) builder_.Pause(Millis(pause_ms));
    flow_.SentenceEdge();
    Children(element);
    flow_.SentenceEdge();
  }

  bool SayAs(const Node& element) {
    const std::string how = element.Get("interpret-as"), text = element.Text();
    auto spoken = SpokenForm(how, element.Get("format"), text, around_.language);
    if (!spoken) {
      if (!vm::xml::IsBlank(text)) NoteSayAs(element, how, text);
      return false;
    }
    Say(vm::xml::Collapse(text), *spoken);
    return true;
  }

  void NoteSayAs(const Node& element, const std::string& how, const std::string& text) {
    const std::string_view expected = ExpectedOf(how);
    if (expected.empty()) return NoteValue(element, "interpret-as");
    const std::string format = element.Get("format").substr(0, 20);
    Note("<say-as interpret-as=\"" + how + (format.empty() ? "" : "\" format=\"" + format) +
         "\">: '" + vm::xml::Collapse(text).substr(0, 40) +
         "' is read as it is written, expected " + std::string(expected));
  }

  void LoadLexicon(const Node& element) {
    const std::string uri = PathOf(element.Get("uri"));
    if (lexicons_.size() >= kMaxLexicons) {
      return Note("more than " + std::to_string(kMaxLexicons) + " lexicons");
    }
    if (!options_.read_file) return NoteValue(element, "uri");
    auto bytes = options_.read_file(uri);
    if (!bytes) return Note("lexicon: " + bytes.error().text);
    auto lexicon = Lexicon::Parse(*bytes, uri);
    if (!lexicon) return Note("lexicon " + lexicon.error().text);
    const auto [at, is_new] =
        lexicons_.emplace(element.Get("xml:id", element.Get("uri")), std::move(*lexicon));
    if (is_new && everywhere_) active_.push_back(&at->second);
  }

  void Looked(const Node& element) {
    const auto found = lexicons_.find(element.Get("ref"));
    if (found == lexicons_.end()) {
      Note("<lookup ref=\"" + element.Get("ref").substr(0, 60) +
           "\">: there is no <lexicon> of that xml:id");
      return Children(element);
    }
    active_.push_back(&found->second);
    Children(element);
    active_.pop_back();
  }

  /// What a URI names, as far as it is a file.
  std::string PathOf(const std::string& uri) const {
    return uri.empty() ? uri : FilePathOf(ResolveUri(around_.base, uri));
  }

  /// False if the file cannot be played: then what the element holds is spoken.
  bool Audio(const Node& element) {
    const std::string path = PathOf(element.Get("src"));
    if (path.empty() || (options_.is_sound && !options_.is_sound(path))) {
      if (!path.empty()) Note("'" + path.substr(0, 200) + "' cannot be played");
      return false;
    }
    SpeechSpan::Clip clip;
    const auto time = [&](const char* name) {
      return values_.Time(element, name, kLongestPlayed).value_or(Millis{0});
    };
    clip.begin = time("clipBegin");
    clip.end = time("clipEnd");
    clip.most = time("repeatDur");
    constexpr double kMostRepeats = 1000;
    const auto count = values_.Count(element, "repeatCount", kMostRepeats);
    clip.repeats = count ? *count : clip.most.count() > 0 ? kMostRepeats : 1;
    clip.speed = values_.Factor(element, "speed", {}, RateFactor, 0.25, 4);
    const double volume = values_.Factor(element, "soundLevel", {}, VolumeFactor, 0, 4);
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
      manner.language = around_.language = first.substr(0, first.find_first_of(" :"));
    }
  }

  void Prosody(const Node& element, SpeechSpan& manner) {
    manner.stretch /= values_.Factor(element, "rate", RateNames(), RateFactor, 0.2, 5);
    manner.volume *= values_.Factor(element, "volume", VolumeNames(), VolumeFactor, 0, 4);
    Intonation& tone = manner.intonation;
    const auto pitch = ReadQuantity(element.Get("pitch"));
    if (pitch && pitch->unit == "Hz") {
      const double hz = std::clamp(pitch->number, -400.0, 800.0);
      if (hz != pitch->number) {
        values_.NoteLimit(element, "pitch", std::to_string(std::lround(hz)) + "Hz");
      }
      (pitch->relative ? tone.shift_hz : tone.hz) = hz;
    } else {
      const double factor = values_.Factor(element, "pitch", PitchNames(), PitchFactor, 0.5, 2);
      manner.pitch *= factor;
      tone.hz *= factor;
    }
    tone.range *= values_.Factor(element, "range", RangeNames(), PitchFactor, 0.1, 4);
    if (element.Has("contour")) {
      if (auto contour = ReadContour(element.Get("contour"))) {
        tone.contour = std::move(*contour);
        manner.element = ++elements_;
      } else {
        NoteValue(element, "contour");
      }
    }
    if (const auto lasts = values_.Time(element, "duration", kLongestAsked)) {
      if (lasts->count() == 0) return NoteValue(element, "duration");
      manner.lasts = *lasts;
      manner.element = elements_ += element.Has("contour") ? 0 : 1;
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
  ValueReader values_{builder_};
  Surroundings around_;
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
