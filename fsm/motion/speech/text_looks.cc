#include "fsm/motion/speech/text_looks.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "fsm/motion/base/easing.h"
#include "fsm/motion/speech/speech_timing.h"
#include "fsm/motion/speech/viseme_target.h"
#include "vm_protocol/core/lower_case.h"

namespace fsm {
namespace {

constexpr std::array<std::string_view, 6> kStops = {".", "!", "?", "。", "！", "？"};

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
/// a pause that is nearer than `near_ms`.
double TimeOfShare(double share, const VisemeTargets& targets, double near_ms) {
  if (share >= 1) return targets.length_ms;
  double spoken = 0, passed = 0, at = targets.length_ms;
  for (const VisemeTarget& target : targets.targets) spoken += target.pause ? 0 : target.length_ms;
  for (const VisemeTarget& target : targets.targets) {
    if (target.pause) continue;
    passed += target.length_ms;
    if (passed < share * spoken) continue;
    at = target.start_ms + target.length_ms - (passed - share * spoken);
    break;
  }
  double nearest = near_ms, found = at;
  for (const VisemeTarget& target : targets.targets) {
    if (!target.pause || target.length_ms < kPhrasePauseMs) continue;
    if (std::abs(target.start_ms - at) < nearest) {
      nearest = std::abs(target.start_ms - at);
      found = target.start_ms;
    }
  }
  return found;
}

}  // namespace

double TimedLook::At(double position_ms, const MovementNumbers& sizes) const {
  const double rise = SmootherStep((position_ms - start_ms) / sizes.look.rise_ms);
  return rise * (1 - SmootherStep((position_ms - end_ms) / sizes.look.fall_ms));
}

std::vector<TimedLook> LooksOf(const TextCues& cues, std::string_view text,
                               const VisemeTargets& targets, const MovementNumbers& sizes) {
  const std::string lowered = vm::LowerCase(WithoutMarkup(text));
  const double letters = Letters(lowered);
  std::vector<TimedLook> timed;
  if (letters == 0) return timed;
  double before = 0, start_ms = 0;
  for (const std::string_view sentence : Sentences(lowered)) {
    before += Letters(sentence);
    const double end_ms = TimeOfShare(before / letters, targets, sizes.look.near_pause_ms);
    std::vector<bool> seen(cues.looks.size());
    for (const TextCues::Cue& cue : cues.cues) {
      const bool here = std::ranges::any_of(
          cue.phrases, [&](const std::string& phrase) { return ContainsPhrase(sentence, phrase); });
      if (!here || seen[cue.look]) continue;
      seen[cue.look] = true;
      const TextLook& look = cues.looks[cue.look];
      const double from = look.at_end ? std::max(start_ms, end_ms - sizes.look.at_end_ms)
                                      : start_ms - sizes.look.lead_ms;
      timed.push_back({&look, from, end_ms});
    }
    start_ms = end_ms;
  }
  return timed;
}

}  // namespace fsm
