#pragma once

#include <string>
#include <string_view>

#include "vm_protocol/core/result.h"

namespace vm {

/// The character encoding at the edge of a stream; inside everything is UTF-8.
enum class Encoding { kUtf8, kEucJp, kShiftJis };

/// "utf-8", "euc-jp", "shift_jis", any case. Error: kBadValue naming the three.
Result<Encoding> ParseEncoding(std::string_view name);
/// Error: kBadUtf8 (any invalid sequence), with the column.
Result<std::string> ToUtf8(std::string_view text, Encoding encoding);
/// Characters that do not exist there become '?'.
std::string FromUtf8(std::string_view text, Encoding encoding);

}  // namespace vm
