#pragma once

#include <optional>
#include <span>
#include <string_view>

#include "fsm/base/table_reader.h"
#include "fsm/motion/motion_patterns.h"
#include "fsm/motion/unit_names.h"

namespace fsm {

/// One kind of what the face does by itself: all that is known about it, but for what it does to
/// the face, which is in IdleBehaviour, or in SpeechMotion if it goes with speech.
struct IdleKindRow {
  IdleKind kind;
  std::string_view name;  ///< of Autonomous and LIFE; its patterns are AUTO lines: AUTOBLINK
  std::string_view help;  ///< what follows the name in a list of them
  /// How many patterns there are; 1 of what is only on or off.
  std::size_t (*count)(const MotionPatterns&);
  /// Reads one of its AUTO lines with TableRow::Fail; null if it has none.
  void (*read)(const TableRow&, const UnitNames&, MotionPatterns&);
  vm::Time fade;              ///< in which it is switched on or off
  bool moves_always = false;  ///< the face never stands still while it is on
};

/// All of them, in the order of IdleKind.
std::span<const IdleKindRow, kIdleKindCount> IdleKinds();
const IdleKindRow& RowOf(IdleKind kind);
std::optional<IdleKind> IdleKindNamed(std::string_view name);

}  // namespace fsm
