#include "ssm/voice/lead.h"

#include <algorithm>

namespace ssm {

Millis CutLead(SpeechPlan& plan, Millis most) {
  if (plan.phonemes.size() < 2) return Millis(0);  // nothing but a pause
  vm::Phoneme& first = plan.phonemes.front();
  if (first.name != "pau" && first.name != "sil") return Millis(0);
  const Millis cut = std::max(first.duration - most, Millis(0));
  first.duration -= cut;
  if (first.duration == Millis(0)) plan.phonemes.erase(plan.phonemes.begin());
  const auto move = [cut](Millis& at) { at = std::max(at - cut, Millis(0)); };
  for (WordTime& word : plan.words) {
    move(word.start);
    move(word.end);
  }
  for (MarkTime& mark : plan.marks) move(mark.at);
  return cut;
}

}  // namespace ssm
