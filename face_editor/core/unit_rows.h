#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "fsm/rig/unit_table.h"
#include "vm_protocol/core/result.h"

namespace editor {

/// A row of action_units.txt: how a unit moves the skin, lids, jaw or tongue of the agent's left
/// side (the right one is its mirror image), or what it does to another unit.
struct UnitRow {
  std::vector<std::string> words;  ///< as they stand in the file; [0] says what the row does
  int line = 0;                    ///< of the text it was read from, from 1; 0 = a new one
};
using UnitRows = std::vector<UnitRow>;

/// The table as it is edited, and what it makes of a head. Immutable, made by ReadUnits.
struct Units {
  std::shared_ptr<const std::string> text;  ///< it was read from
  UnitRows rows;
  fsm::UnitTable table;
};

/// A word of a row that can be edited.
struct UnitColumn {
  std::string_view name;
  float low, high;  ///< of its slider; the table takes more. Both 0: above, below or both
};
/// A kind of row.
struct UnitRowKind {
  std::string_view word, meaning;
  std::size_t first;  ///< index of the first column's word
  std::vector<UnitColumn> columns;
  std::string_view example;  ///< what follows the unit in a new row
};
const std::vector<UnitRowKind>& UnitRowKinds();
/// nullptr for a word that begins no row.
const UnitRowKind* KindOf(const UnitRow& row);

/// Errors: kBadValue with file and line.
vm::Result<std::shared_ptr<const Units>> ReadUnits(const std::string& name, std::string_view text);
/// The same with other rows. Error: kBadValue without a place.
vm::Result<std::shared_ptr<const Units>> WithRows(const Units& units, UnitRows rows);
/// Indices of the rows that say what a unit does.
std::vector<std::size_t> RowsOf(const UnitRows& rows, int unit);
/// The table written back into the text it was read from: comments, blank lines and rows that say
/// the same stay as they are, and of the others all words that do.
std::string WriteUnits(const Units& units);

}  // namespace editor
