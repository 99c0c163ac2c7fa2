#pragma once

#include <string>
#include <vector>

#include "fsm/base/table_folder.h"
#include "vm_protocol/core/result.h"

namespace fsm {

/// Checks the tables of a folder against each other and against the built-in ones. Returns notices,
/// one line each, about files that have no table's name and are therefore not read, and about units
/// that have no rows in action_units.txt and therefore move nothing; each names at most
/// kMaxListed. Errors: kBadValue "FILE:LINE: ..." if action_units.txt has a row for a number that
/// is not a unit in action_unit_names.txt, or if one of these or features.txt is damaged;
/// kUnavailable.
vm::Result<std::vector<std::string>> CheckTables(const TableFolder& folder);

/// Returns "a, b, c and 4 more", for notices: at most kMaxListed words, each cut to 60 bytes.
/// Bytes that are not text are replaced by '?', because names from files may contain any.
std::string Listed(const std::vector<std::string>& words);
inline constexpr std::size_t kMaxListed = 8;

}  // namespace fsm
