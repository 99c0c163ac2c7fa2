#include "agent_manager/routing/machine_questions.h"

#include <utility>

#include "agent_manager/routing/tag.h"

namespace am {

std::string MachineQuestions::Add(OnAnswer done) {
  if (open_.size() >= limits_.pending) {
    const OnAnswer oldest = std::move(open_.begin()->second);
    open_.erase(open_.begin());
    queue_.Post(
        [oldest] { oldest(vm::Fail(vm::Errc::kTimeout, "too many requests are unanswered")); });
  }
  open_.emplace_hint(open_.end(), ++last_number_, std::move(done));
  return FormatTag('i', last_number_);
}

void MachineQuestions::Resolve(const vm::Message& answer) {
  const auto asked = open_.find(NumberOfTag('i', answer.tag));
  if (asked == open_.end()) return;
  const OnAnswer done = std::move(asked->second);
  open_.erase(asked);
  const bool refused = answer.slot.ends_with(".error");
  queue_.Post([done, refused, value = answer.value] {
    refused ? done(vm::Fail(vm::Errc::kUnavailable, value)) : done(value);
  });
}

}  // namespace am
