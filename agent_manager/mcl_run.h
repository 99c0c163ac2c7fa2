#pragma once

#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "agent_manager/mcl.h"

/// A run of a macro, shared by the files that make up the macro layer. Not for others.
namespace am {

/// One macro being carried out.
struct Mcl::Run {
  enum class Phase { kSteps, kStopping, kFinally };
  unsigned long id = 0;
  std::shared_ptr<const Macro> macro;
  Variables variables;
  Phase phase = Phase::kSteps;
  std::size_t next = 0;
  std::vector<Heard> heard;  // since the start or the last mark
  std::vector<const MacroStep*> followers;
  const MacroStep* waiting = nullptr;  // a kWait under way
  std::optional<unsigned> asking;      // a kRequest under way, by its number
  unsigned asked = 0;
  vm::TimerId timer = 0;
  std::set<std::string> involved;  // modules spoken to: their death ends the run
  std::optional<vm::Error> error;
  vm::Reply reply;
  std::vector<vm::Reply> stop_replies;
  // Branches: runs of their own that share the outcome with the run they belong to.
  unsigned long parent = 0;  // 0: none
  std::set<unsigned long> branches;
  std::optional<std::pair<Variables, vm::Reply>> successor;  // begins when this one has ended

  const std::vector<MacroStep>& list() const {
    return phase == Phase::kSteps      ? macro->steps
           : phase == Phase::kStopping ? macro->on_stop
                                       : macro->finally;
  }
};

}  // namespace am
