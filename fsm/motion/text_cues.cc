#include "fsm/motion/text_cues.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "fsm/motion/easing.h"
#include "fsm/motion/table_text.h"
#include "fsm/motion/viseme_target.h"

namespace fsm {
namespace {

constexpr std::size_t kMostLooks = 100, kMostCues = 1000;
constexpr double kMostDegrees = 30;
constexpr double kPauseMs = 110;
constexpr double kNearPauseMs = 600;  // a sentence ends at a pause that is no further away
constexpr double kRiseMs = 350, kFallMs = 500, kAheadMs = 150;
constexpr double kEndMs = 700;  // of looks at the end of a sentence
constexpr std::array<std::string_view, 6> kStops = {".", "!", "?", "。", "！", "？"};

std::string Lowered(std::string_view text) {
  std::string out(text);
  for (char& c : out) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return out;
}

// ---- the table

class CueReader {
 public:
  CueReader(const std::string& name, std::string_view text, const UnitNames& names)
      : table_(name, text), names_(names) {}

  vm::Result<TextCues> Read() {
    for (const TableLine& line : table_.lines()) {
      const auto read =
          line.words[0] == "look" ? ReadLook(line)
          : line.words[0] == "cue"
              ? ReadCue(line)
              : table_.Wrong(line.number, "'" + line.words[0] + "' found, look or cue expected");
      if (!read) return std::unexpected(read.error());
    }
    return std::move(out_);
  }

 private:
  vm::Result<void> ReadLook(const TableLine& line) {
    if (line.words.size() < 6 || (line.words[2] != "ALL" && line.words[2] != "END")) {
      return table_.Wrong(line.number, "look NAME ALL|END DOWN TURN TILT AU:WEIGHT ... expected");
    }
    if (auto named = table_.Name(line, 1, "a look"); !named) return named;
    if (std::ranges::find(out_.looks, line.words[1], &TextLook::name) != out_.looks.end()) {
      return table_.Wrong(line.number, "the look '" + line.words[1] + "' is here twice");
    }
    if (out_.looks.size() == kMostLooks) return table_.Wrong(line.number, "more than 100 looks");
    TextLook look{.name = line.words[1], .at_end = line.words[2] == "END", .head = {}, .units = {}};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto angle = table_.Number(line, 3 + axis, "degrees", -kMostDegrees, kMostDegrees);
      if (!angle) return std::unexpected(angle.error());
      look.head[axis] = static_cast<float>(*angle);
    }
    auto units = ReadUnits(table_, line, 6, names_);
    if (!units) return std::unexpected(units.error());
    look.units = std::move(*units);
    out_.looks.push_back(std::move(look));
    return {};
  }

  vm::Result<void> ReadCue(const TableLine& line) {
    if (line.words.size() < 3) {
      return table_.Wrong(line.number, "cue LOOK PHRASE | PHRASE ... expected");
    }
    const auto look = std::ranges::find(out_.looks, line.words[1], &TextLook::name);
    if (look == out_.looks.end()) {
      return table_.Wrong(line.number, "no look '" + line.words[1] + "' found above");
    }
    if (out_.cues.size() == kMostCues) return table_.Wrong(line.number, "more than 1000 cues");
    TextCues::Cue cue{static_cast<std::size_t>(look - out_.looks.begin()), {""}};
    for (std::size_t i = 2; i < line.words.size(); ++i) {
      if (line.words[i] == "|") {
        cue.phrases.emplace_back();
      } else {
        cue.phrases.back() += (cue.phrases.back().empty() ? "" : " ") + Lowered(line.words[i]);
      }
    }
    if (std::ranges::find(cue.phrases, "") != cue.phrases.end()) {
      return table_.Wrong(line.number, "nothing found beside a '|', a phrase expected");
    }
    out_.cues.push_back(std::move(cue));
    return {};
  }

  TableText table_;
  const UnitNames& names_;
  TextCues out_;
};

// ---- sentences

/// Without what stands between < and >: marks of speech synthesis.
std::string WithoutMarkup(std::string_view text) {
  std::string out;
  bool in_mark = false;
  for (const char c : text) {
    if (c == '<') in_mark = true;
    if (!in_mark) out += c;
    if (c == '>') in_mark = false;
  }
  return out;
}

bool IsLetter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || static_cast<unsigned char>(c) >= 0x80;
}

bool Holds(std::string_view sentence, std::string_view phrase) {
  const bool words = IsLetter(phrase.front()) && static_cast<unsigned char>(phrase.front()) < 0x80;
  for (std::size_t at = sentence.find(phrase); at != std::string_view::npos;
       at = sentence.find(phrase, at + 1)) {
    const std::size_t end = at + phrase.size();
    if (!words) return true;
    if ((at == 0 || !IsLetter(sentence[at - 1])) &&
        (end == sentence.size() || !IsLetter(sentence[end]))) {
      return true;
    }
  }
  return false;
}

/// Each with its stop. A stop within a number or a word is none.
std::vector<std::string_view> Sentences(std::string_view text) {
  std::vector<std::string_view> sentences;
  std::size_t begin = 0;
  for (std::size_t at = 0; at < text.size();) {
    const auto stop = std::ranges::find_if(
        kStops, [&](std::string_view s) { return text.substr(at).starts_with(s); });
    if (stop == kStops.end()) {
      ++at;
      continue;
    }
    at += stop->size();
    if (stop->size() == 1 && at < text.size() && IsLetter(text[at])) continue;
    sentences.push_back(text.substr(begin, at - begin));
    begin = at;
  }
  if (begin < text.size()) sentences.push_back(text.substr(begin));
  return sentences;
}

double Letters(std::string_view text) {
  return static_cast<double>(std::ranges::count_if(text, IsLetter));
}

/// When so great a share of what is spoken has been spoken, without pauses; at the beginning of a
/// pause if one is near.
double TimeOfShare(double share, const VisemeTargets& visemes) {
  if (share >= 1) return visemes.length_ms;
  double spoken = 0, passed = 0, at = visemes.length_ms;
  for (const VisemeTarget& viseme : visemes.targets) spoken += viseme.pause ? 0 : viseme.length_ms;
  for (const VisemeTarget& viseme : visemes.targets) {
    if (viseme.pause) continue;
    passed += viseme.length_ms;
    if (passed < share * spoken) continue;
    at = viseme.start_ms + viseme.length_ms - (passed - share * spoken);
    break;
  }
  double nearest = kNearPauseMs, found = at;
  for (const VisemeTarget& viseme : visemes.targets) {
    if (!viseme.pause || viseme.length_ms < kPauseMs) continue;
    if (std::abs(viseme.start_ms - at) < nearest) {
      nearest = std::abs(viseme.start_ms - at);
      found = viseme.start_ms;
    }
  }
  return found;
}

}  // namespace

vm::Result<TextCues> ReadTextCues(const std::string& name, std::string_view text,
                                  const UnitNames& names) {
  return CueReader(name, text, names).Read();
}

double TimedLook::At(double position_ms) const {
  const double rise = SmootherStep((position_ms - start_ms) / kRiseMs);
  return rise * (1 - SmootherStep((position_ms - end_ms) / kFallMs));
}

std::vector<TimedLook> LooksOf(const TextCues& cues, std::string_view text,
                               const VisemeTargets& visemes) {
  const std::string lowered = Lowered(WithoutMarkup(text));
  const double letters = Letters(lowered);
  std::vector<TimedLook> timed;
  if (letters == 0) return timed;
  double before = 0, start_ms = 0;
  for (const std::string_view sentence : Sentences(lowered)) {
    before += Letters(sentence);
    const double end_ms = TimeOfShare(before / letters, visemes);
    std::vector<bool> seen(cues.looks.size());
    for (const TextCues::Cue& cue : cues.cues) {
      const bool here = std::ranges::any_of(
          cue.phrases, [&](const std::string& phrase) { return Holds(sentence, phrase); });
      if (!here || seen[cue.look]) continue;
      seen[cue.look] = true;
      const TextLook& look = cues.looks[cue.look];
      const double from = look.at_end ? std::max(start_ms, end_ms - kEndMs) : start_ms - kAheadMs;
      timed.push_back({&look, from, end_ms});
    }
    start_ms = end_ms;
  }
  return timed;
}

}  // namespace fsm
