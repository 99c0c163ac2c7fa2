#pragma once

#include <string>
#include <string_view>

#include "vm_protocol/core/result.h"

namespace vm {

// Text between UTF-8 and any character set the system's iconv knows, by its name in any case.
// Every spelling of Shift_JIS means CP932, the superset that files on PCs are written in (with
// half-width kana and the signs of NEC and IBM).

/// Errors: kBadValue if nobody knows the set; kBadUtf8 with the column of the first byte that is
/// not part of it.
Result<std::string> DecodeCharset(std::string_view bytes, const std::string& charset);

/// Characters the set lacks become '?'. Error: kBadValue if nobody knows the set.
Result<std::string> EncodeCharset(std::string_view text, const std::string& charset);

}  // namespace vm
