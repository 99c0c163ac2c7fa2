#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace vm {

/// Byte position (0-based) of the first byte that is not part of well-formed UTF-8 (RFC 3629: no
/// overlong forms, no surrogates, at most U+10FFFF); none = all well.
std::optional<std::size_t> FirstBadUtf8(std::string_view text);

/// How many bytes at the beginning are ASCII.
std::size_t AsciiPrefix(std::string_view text);

/// One sign of a text and how many bytes it takes.
struct CodePoint {
  char32_t value = 0;
  std::size_t length = 0;
};
/// The sign that begins at `at`; none at the end, or where no well-formed sequence begins.
std::optional<CodePoint> DecodeUtf8(std::string_view text, std::size_t at);
/// The same; where DecodeUtf8 finds none, U+FFFD, one byte long.
CodePoint SignAt(std::string_view text, std::size_t at);
/// All signs of a text; each byte that is not UTF-8 becomes U+FFFD.
std::u32string SignsOf(std::string_view text);

/// REQUIRES: a Unicode scalar value.
void AppendUtf8(std::string& out, char32_t sign);
/// REQUIRES: Unicode scalar values.
std::string Utf8Of(std::u32string_view signs);

/// False for a byte that only continues a sequence (0x80 to 0xBF).
bool BeginsSign(char byte);

/// The beginning of a text, at most `max_bytes` long, that does not end within a sign.
std::string_view CutUtf8(std::string_view text, std::size_t max_bytes);

/// Bytes from anywhere as text that can stand in a message and on a terminal: each byte that is not
/// UTF-8 becomes U+FFFD, each control character (also DEL, U+0080 to U+009F) a blank.
std::string ShownUtf8(std::string_view bytes);

}  // namespace vm
