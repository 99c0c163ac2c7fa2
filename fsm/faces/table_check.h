#pragma once

#include <string>
#include <vector>

#include "fsm/base/table_folder.h"
#include "vm_protocol/core/result.h"

namespace fsm {

/// Looks at what the tables of a folder have to do with each other, and with those the program
/// carries. Notices, a line each: which files have no table's name and so are not read, and which
/// units have no rows in action_units.txt and so move nothing. At most kMostListed are named of
/// each. Errors: kBadValue "FILE:LINE: ..." where action_units.txt has a row of
/// a number that is no unit in action_unit_names.txt, or either or features.txt is damaged;
/// kUnavailable.
vm::Result<std::vector<std::string>> CheckTables(const TableFolder& folder);

/// "a, b, c and 4 more", for notices: at most kMostListed words, each of at most 60 bytes. Names
/// out of files may hold anything; what is not text is shown as '?'.
std::string Listed(const std::vector<std::string>& words);
inline constexpr std::size_t kMostListed = 8;

}  // namespace fsm
