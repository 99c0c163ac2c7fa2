#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "ssm/flite/flite_take.h"

namespace ssm {

/// One call of the engine: a sentence, or a silence where its text is empty.
struct FliteUnit {
  FliteSentence sentence{};
  double volume = 1;
  Millis skip{0};  ///< what of the engine's sound at its beginning is left out
  Millis length{0};
  std::shared_ptr<FliteTake> take{};  ///< its sound, if that is being made already
};

struct FliteDetail : SpeechPlan::Detail {
  std::vector<FliteUnit> units;
};

inline bool IsPause(const vm::Phoneme& phoneme) { return phoneme.name == "pau"; }

/// Collects units into one list of phonemes, and decides what happens where two of them meet.
class FliteAssembly {
 public:
  void Silence(Millis length) {
    if (length.count() > 0) Pause(length);
  }
  void Mark(const std::string& name) {
    if (!name.empty()) plan_.marks.push_back({name, at_});
  }
  /// `goes_on`: the unit before was cut where a sentence or a comma ends; else it may have been cut
  /// anywhere.
  void Sentence(FliteUnit unit, FliteAnalysis analysis, bool goes_on) {
    auto& phonemes = analysis.phonemes;
    if (spoke_ && !goes_on && !ended_) {
      // The voice changes inside a sentence: the engine's pauses there are none of the text's.
      if (phonemes.size() > 1 && IsPause(phonemes.front())) {
        unit.skip = phonemes.front().duration;
        phonemes.erase(phonemes.begin());
      }
      if (!punctuated_) DropLastPause();
    }
    unit.length = vm::TotalDuration(phonemes);
    for (WordTime word : analysis.words) {
      word.start += at_ - unit.skip;
      word.end += at_ - unit.skip;
      plan_.words.push_back(std::move(word));
    }
    const std::size_t last = unit.sentence.text.find_last_not_of(" \"')");
    punctuated_ =
        last != std::string::npos && std::string_view(".,;:!?").contains(unit.sentence.text[last]);
    ended_ =
        last != std::string::npos && std::string_view(".!?").contains(unit.sentence.text[last]);
    spoke_ = true;
    for (vm::Phoneme& phoneme : phonemes) Add(std::move(phoneme));
    units_.push_back(std::move(unit));
  }
  SpeechPlan Finish() {
    if (plan_.phonemes.empty()) Pause(kEmptyPause);
    auto detail = std::make_shared<FliteDetail>();
    detail->units = std::move(units_);
    plan_.detail = std::move(detail);
    return std::move(plan_);
  }

 private:
  void Add(vm::Phoneme phoneme) {
    at_ += phoneme.duration;
    if (!plan_.phonemes.empty() && IsPause(plan_.phonemes.back()) && IsPause(phoneme)) {
      plan_.phonemes.back().duration += phoneme.duration;
    } else {
      plan_.phonemes.push_back(std::move(phoneme));
    }
  }
  void Pause(Millis length) {
    units_.push_back({.length = length});
    Add({"pau", length});
  }
  void DropLastPause() {
    // Only of a sentence: a silence asked for (an empty unit) stays.
    if (units_.empty() || units_.back().sentence.text.empty() || plan_.phonemes.size() < 2) return;
    vm::Phoneme& last = plan_.phonemes.back();
    if (!IsPause(last) || last.duration >= units_.back().length) return;
    at_ -= last.duration;
    units_.back().length -= last.duration;
    for (MarkTime& mark : plan_.marks) mark.at = std::min(mark.at, at_);
    plan_.phonemes.pop_back();
  }

  SpeechPlan plan_;
  std::vector<FliteUnit> units_;
  Millis at_{0};
  bool spoke_ = false;
  bool punctuated_ = false;  ///< the last sentence ends in a sign
  bool ended_ = false;       ///< in one that ends a sentence
};

}  // namespace ssm
