#pragma once

#include <string_view>

#include "fsm/motion/inputs/expression_table.h"
#include "vm_protocol/core/result.h"

namespace fsm {

struct MotionTables;

/// The expressions of a face: those of its tables, and those that are defined while it moves.
/// Lifetime: `tables` outlives this. Errors: kBadValue, kLimit for too many expressions.
class ExpressionStore {
 public:
  explicit ExpressionStore(const MotionTables& tables);

  const ExpressionTable& all() const { return all_; }
  /// Adds or changes a pattern of an expression. `pattern` is at most one more than those that
  /// exist. `name` consists of at most 40 letters, digits and _.
  vm::Result<void> Define(std::string_view name, int pattern, std::string_view look);
  /// Undoes Define: restores an expression of the tables and removes one that they do not have.
  void Forget(std::string_view name);

 private:
  const MotionTables& tables_;
  ExpressionTable all_;
};

}  // namespace fsm
