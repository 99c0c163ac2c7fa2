#pragma once

#include <optional>
#include <string>
#include <vector>

#include "vm_protocol/core/result.h"

namespace fsm {

/// The text of one table of a folder; nothing if the folder is "" or has none of that name. Throws
/// std::runtime_error naming the file if it cannot be read or is not UTF-8.
std::optional<std::string> TableIn(const std::string& folder, const std::string& file);

/// Looks at what the tables of a folder have to do with each other, and with those the program
/// carries. Notices, a line each: which files have no table's name and so are not read, and which
/// units have no rows in action_units.txt and so move nothing. At most kMostListed are named of
/// each. Folder "": nothing. Errors: kBadValue "FILE:LINE: ..." where action_units.txt has a row of
/// a number that is no unit in action_unit_names.txt, or either or features.txt is damaged;
/// kUnavailable.
vm::Result<std::vector<std::string>> CheckTables(const std::string& folder);

/// "a, b, c and 4 more", for notices: at most kMostListed words, each of at most 60 bytes. Names
/// out of files may hold anything; what is not text is shown as '?'.
std::string Listed(const std::vector<std::string>& words);
inline constexpr std::size_t kMostListed = 8;

}  // namespace fsm
