#pragma once

#include <deque>
#include <functional>
#include <string>
#include <string_view>

#include "face_editor/core/state.h"

namespace editor {

/// The state and how it came about. Limit: the last kMostSteps steps can be taken back.
class History {
 public:
  static constexpr std::size_t kMostSteps = 300;

  explicit History(State first) { steps_.push_back({std::move(first), "", ""}); }

  const State& now() const { return steps_[at_].state; }
  /// Changes one part. Changes that follow each other with the same `merge` (not empty) are one
  /// step until Seal: a drag is taken back at once.
  void Change(Part part, std::string what, std::string_view merge,
              const std::function<void(State&)>& change);
  void Seal() { steps_[at_].merge.clear(); }

  bool can_undo() const { return at_ > 0; }
  bool can_redo() const { return at_ + 1 < steps_.size(); }
  /// What would be taken back or done again; "" if nothing.
  std::string_view undo_name() const {
    return can_undo() ? std::string_view(steps_[at_].what) : "";
  }
  std::string_view redo_name() const {
    return can_redo() ? std::string_view(steps_[at_ + 1].what) : "";
  }
  bool Undo();
  bool Redo();
  /// Puts in a part that was read from outside; what came before cannot be brought back.
  void Restart(Part part, const std::function<void(State&)>& change);

 private:
  struct Step {
    State state;
    std::string what;  ///< led here
    std::string merge;
  };
  // Never empty; a deque, so that what a change is made of may be part of the state before it.
  std::deque<Step> steps_;
  std::size_t at_ = 0;
  std::uint64_t versions_ = 0;
};

}  // namespace editor
