#pragma once

#include <chrono>
#include <string>
#include <string_view>
#include <vector>

#include "vm_protocol/core/scheduler.h"
#include "vm_protocol/core/slot_machine.h"

namespace ear {

/// One way to take an utterance.
struct Candidate {
  std::string text{};
  std::string grammar{};  ///< the one that matched; empty without one
  std::string tag{};      ///< its meaning
  double confidence = 1;  ///< 0 to 1
};

/// What came of an utterance.
struct ResultReport {
  vm::Time start{0};
  vm::Time end{0};
  std::vector<Candidate> candidates{};  ///< best first; empty = no match
};

/// <result start="MS" end="MS"><candidate rank="1" confidence="C" grammar="NAME"
/// tag="MEANING">TEXT</candidate>...</result> on one line.
std::string FormatResult(const ResultReport& report);

/// Declares Result and what is said of it before, NoMatch and NoInput.
void DeclareResultSlots(vm::SlotMachine& slots);
/// Reports the best candidate, or what was `heard` as NoMatch.
void TellResult(vm::SlotMachine& slots, const ResultReport& report, const std::string& heard);

}  // namespace ear
