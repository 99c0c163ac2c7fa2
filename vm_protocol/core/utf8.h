#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

namespace vm {

/// Byte position (0-based) of the first byte that is not part of well-formed UTF-8 (RFC 3629: no
/// overlong forms, no surrogates, at most U+10FFFF); none = all well.
std::optional<std::size_t> FirstBadUtf8(std::string_view text);

}  // namespace vm
