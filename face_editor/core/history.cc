#include "face_editor/core/history.h"

namespace editor {

void History::Change(Part part, std::string what, std::string_view merge,
                     const std::function<void(State&)>& change) {
  steps_.resize(at_ + 1, steps_.front());
  const bool same = at_ > 0 && !merge.empty() && steps_[at_].merge == merge;
  if (!same) {
    Seal();
    if (steps_.size() > kMostSteps) {
      steps_.pop_front();
      --at_;
    }
    steps_.push_back(Step{steps_[at_].state, std::move(what), std::string(merge)});
    ++at_;
  }
  change(steps_[at_].state);
  steps_[at_].state.version[static_cast<std::size_t>(part)] = ++versions_;
}

bool History::Undo() {
  if (!can_undo()) return false;
  Seal();
  --at_;
  Seal();
  return true;
}

bool History::Redo() {
  if (!can_redo()) return false;
  ++at_;
  Seal();
  return true;
}

void History::Restart(Part part, const std::function<void(State&)>& change) {
  State state = now();
  change(state);
  state.version[static_cast<std::size_t>(part)] = ++versions_;
  steps_.assign(1, Step{std::move(state), "", ""});
  at_ = 0;
}

}  // namespace editor
