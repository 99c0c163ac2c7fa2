#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "fsm/app/fsm_core.h"

namespace fsm {

/// The slots FaceExp.NAME.PATTERN, the looks of expressions, which can be queried, set and saved.
/// `def FaceExp.NAME = LOOK` (pattern 1) and `def FaceExp.NAME.PATTERN = LOOK` define new ones;
/// `del FaceExp.NAME` removes a new one and restores a changed one. `Run = INIT` undoes all.
/// Limit: kMaxOwnSlots new slots between two of these.
class ExpressionSlots final : public SlotGroup {
 public:
  static constexpr std::size_t kMaxOwnSlots = 200;
  struct Name {
    std::string expression;
    int pattern = 1;
  };
  /// Declares the slots. `core` outlives this.
  explicit ExpressionSlots(FsmCore& core);
  void RestoreInitial() override;

 private:
  void Declare(const Name& name, const std::string& look);
  std::optional<std::string> LookOf(const Name& name) const;
  vm::Result<std::string> Define(const Name& name, const std::string& look);
  vm::Result<std::string> Forget(const std::string& expression);

  FsmCore& core_;
  std::vector<std::string> own_;  // names of slots defined by `def`
};

}  // namespace fsm
