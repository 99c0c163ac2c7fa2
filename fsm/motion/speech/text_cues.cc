#include "fsm/motion/speech/text_cues.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "fsm/base/table_reader.h"
#include "fsm/motion/easing.h"
#include "fsm/motion/speech/speech_timing.h"
#include "fsm/motion/speech/viseme_target.h"
#include "vm_protocol/core/lower_case.h"

namespace fsm {
namespace {

constexpr std::size_t kMostLooks = 100, kMostCues = 1000;
constexpr float kMostDegrees = 30;
constexpr double kNearPauseMs = 600;  // greatest distance of the pause at which a sentence ends
constexpr double kRiseMs = 350, kFallMs = 500, kAheadMs = 150;
constexpr double kEndMs = 700;  // duration of looks at the end of a sentence
constexpr std::array<std::string_view, 6> kStops = {".", "!", "?", "。", "！", "？"};

// ---- the table

TextLook ReadTextLook(const TableRow& row, const TextCues& cues, const UnitNames& names) {
  if (row.size() < 6 || (row.Word(2) != "ALL" && row.Word(2) != "END")) {
    row.Fail("look NAME ALL|END DOWN TURN TILT AU:WEIGHT ... expected");
  }
  TextLook look{
      .name = row.Name(1, "a look"), .at_end = row.Word(2) == "END", .head = {}, .units = {}};
  if (std::ranges::find(cues.looks, look.name, &TextLook::name) != cues.looks.end()) {
    row.Fail("the look '" + look.name + "' is here twice");
  }
  if (cues.looks.size() == kMostLooks) row.Fail("more than 100 looks");
  for (std::size_t axis = 0; axis < 3; ++axis) {
    look.head[axis] = row.Within(3 + axis, -kMostDegrees, kMostDegrees);
  }
  look.units = ReadLook(row, 6, names);
  return look;
}

TextCues::Cue ReadCue(const TableRow& row, const TextCues& cues) {
  if (row.size() < 3) row.Fail("cue LOOK PHRASE | PHRASE ... expected");
  const auto look = std::ranges::find(cues.looks, row.Word(1), &TextLook::name);
  if (look == cues.looks.end()) row.Fail("no look '" + row.Word(1) + "' found above");
  if (cues.cues.size() == kMostCues) row.Fail("more than 1000 cues");
  TextCues::Cue cue{static_cast<std::size_t>(look - cues.looks.begin()), {""}};
  for (std::size_t i = 2; i < row.size(); ++i) {
    if (row.Word(i) == "|") {
      cue.phrases.emplace_back();
    } else {
      cue.phrases.back() += (cue.phrases.back().empty() ? "" : " ") + vm::LowerCase(row.Word(i));
    }
  }
  if (std::ranges::find(cue.phrases, "") != cue.phrases.end()) {
    row.Fail("nothing found beside a '|', a phrase expected");
  }
  return cue;
}

// ---- sentences

/// Returns the text without speech synthesis markup, which is enclosed in < and >.
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

bool ContainsPhrase(std::string_view sentence, std::string_view phrase) {
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

/// Splits a text into sentences, each with its final mark. A dot within a number or word does not
/// end one.
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

/// Returns the time at which `share` of the speech without pauses has been spoken, or the start of
/// a nearby pause.
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
    if (!viseme.pause || viseme.length_ms < kPhrasePauseMs) continue;
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
  return ReadTable(name, text, [&](const Table& table) {
    TextCues cues;
    for (const TableRow& row : table.rows()) {
      if (row.key() == "look") {
        cues.looks.push_back(ReadTextLook(row, cues, names));
      } else if (row.key() == "cue") {
        cues.cues.push_back(ReadCue(row, cues));
      } else {
        row.Fail("'" + row.key() + "' found, look or cue expected");
      }
    }
    return cues;
  });
}

double TimedLook::At(double position_ms) const {
  const double rise = SmootherStep((position_ms - start_ms) / kRiseMs);
  return rise * (1 - SmootherStep((position_ms - end_ms) / kFallMs));
}

std::vector<TimedLook> LooksOf(const TextCues& cues, std::string_view text,
                               const VisemeTargets& visemes) {
  const std::string lowered = vm::LowerCase(WithoutMarkup(text));
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
          cue.phrases, [&](const std::string& phrase) { return ContainsPhrase(sentence, phrase); });
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
