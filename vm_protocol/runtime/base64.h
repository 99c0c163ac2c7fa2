#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace vm {

/// The bytes of base64 (RFC 4648 section 4, by OpenSSL), as data URIs hold it: blanks and line ends
/// do not count, '=' at the end may be left out. None if it is anything else, or over 1 GiB.
std::optional<std::string> DecodeBase64(std::string_view text);
/// The same the other way, on one line. REQUIRES: at most 1 GiB.
std::string EncodeBase64(std::string_view bytes);

}  // namespace vm
