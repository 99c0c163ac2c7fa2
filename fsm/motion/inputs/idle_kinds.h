#pragma once

#include <optional>
#include <span>
#include <string_view>

#include "fsm/base/table_reader.h"
#include "fsm/motion/base/unit_names.h"
#include "fsm/motion/inputs/motion_patterns.h"

namespace fsm {

/// The properties of a kind of idle behaviour. Its effect on the face is in IdleBehaviour, or in
/// SpeechMotion if it accompanies speech.
struct IdleKindRow {
  IdleKind kind;
  /// As in the slot Autonomous and LIFE lines; AUTO lines (AUTOBLINK) have its patterns.
  std::string_view name;
  std::string_view help;  ///< the text after the name in the help
  /// Returns the number of patterns; 1 for a kind that is only on or off.
  std::size_t (*count)(const MotionPatterns&);
  /// Reads one of its AUTO lines; an error is reported by TableRow::Refuse. Null if it has none.
  void (*read)(const TableRow&, const UnitNames&, MotionPatterns&);
  vm::Time fade;              ///< the time in which it fades in or out
  bool moves_always = false;  ///< the face never stands still while it is on
};

/// Returns the rows of all kinds, in the order of IdleKind.
std::span<const IdleKindRow, kIdleKindCount> IdleKinds();
const IdleKindRow& RowOf(IdleKind kind);
std::optional<IdleKind> IdleKindNamed(std::string_view name);

}  // namespace fsm
