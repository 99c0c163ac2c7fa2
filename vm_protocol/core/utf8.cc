#include "vm_protocol/core/utf8.h"

#include <cstdint>
#include <cstring>

namespace vm {
namespace {

unsigned Byte(std::string_view text, std::size_t i) { return static_cast<unsigned char>(text[i]); }

/// How many bytes the sequence starting at `i` has; 0 if it is malformed.
/// The ranges are Table 3-7 of the Unicode Standard, "Well-Formed UTF-8 Byte Sequences".
std::size_t SequenceLength(std::string_view text, std::size_t i) {
  const unsigned lead = Byte(text, i);
  std::size_t length = 0;
  unsigned low = 0x80;
  unsigned high = 0xBF;
  if (lead < 0x80) return 1;
  if (lead >= 0xC2 && lead <= 0xDF) {
    length = 2;
  } else if (lead >= 0xE0 && lead <= 0xEF) {
    length = 3;
    if (lead == 0xE0) low = 0xA0;
    if (lead == 0xED) high = 0x9F;
  } else if (lead >= 0xF0 && lead <= 0xF4) {
    length = 4;
    if (lead == 0xF0) low = 0x90;
    if (lead == 0xF4) high = 0x8F;
  } else {
    return 0;
  }
  if (i + length > text.size()) return 0;
  if (Byte(text, i + 1) < low || Byte(text, i + 1) > high) return 0;
  for (std::size_t k = 2; k < length; ++k) {
    if (BeginsSign(text[i + k])) return 0;
  }
  return length;
}

}  // namespace

std::size_t AsciiPrefix(std::string_view text) {
  constexpr std::uint64_t kHighBits = 0x8080808080808080;
  std::size_t i = 0;
  for (std::uint64_t word = 0; i + sizeof(word) <= text.size(); i += sizeof(word)) {
    std::memcpy(&word, text.data() + i, sizeof(word));
    if ((word & kHighBits) != 0) break;
  }
  while (i < text.size() && Byte(text, i) < 0x80) ++i;
  return i;
}

std::optional<std::size_t> FirstBadUtf8(std::string_view text) {
  std::size_t i = AsciiPrefix(text);  // most lines are nothing else
  while (i < text.size()) {
    const std::size_t length = SequenceLength(text, i);
    if (length == 0) return i;
    i += length;
  }
  return std::nullopt;
}

std::optional<CodePoint> DecodeUtf8(std::string_view text, std::size_t at) {
  if (at >= text.size()) return std::nullopt;
  const std::size_t length = SequenceLength(text, at);
  if (length == 0) return std::nullopt;
  constexpr unsigned kLeadBits[] = {0, 0x7F, 0x1F, 0x0F, 0x07};
  char32_t value = Byte(text, at) & kLeadBits[length];
  for (std::size_t k = 1; k < length; ++k) value = (value << 6) | (Byte(text, at + k) & 0x3F);
  return CodePoint{value, length};
}

CodePoint SignAt(std::string_view text, std::size_t at) {
  return DecodeUtf8(text, at).value_or(CodePoint{0xFFFD, 1});
}

std::u32string SignsOf(std::string_view text) {
  std::u32string signs;
  for (std::size_t at = 0; at < text.size();) {
    const CodePoint sign = SignAt(text, at);
    signs += sign.value;
    at += sign.length;
  }
  return signs;
}

void AppendUtf8(std::string& out, char32_t sign) {
  const auto put = [&out](char32_t byte) { out += static_cast<char>(byte); };
  if (sign < 0x80) {
    put(sign);
  } else if (sign < 0x800) {
    put(0xC0 | (sign >> 6));
    put(0x80 | (sign & 0x3F));
  } else if (sign < 0x10000) {
    put(0xE0 | (sign >> 12));
    put(0x80 | ((sign >> 6) & 0x3F));
    put(0x80 | (sign & 0x3F));
  } else {
    put(0xF0 | (sign >> 18));
    put(0x80 | ((sign >> 12) & 0x3F));
    put(0x80 | ((sign >> 6) & 0x3F));
    put(0x80 | (sign & 0x3F));
  }
}

std::string Utf8Of(std::u32string_view signs) {
  std::string text;
  for (const char32_t sign : signs) AppendUtf8(text, sign);
  return text;
}

bool BeginsSign(char byte) { return (static_cast<unsigned char>(byte) & 0xC0) != 0x80; }

std::string_view CutUtf8(std::string_view text, std::size_t max_bytes) {
  if (text.size() <= max_bytes) return text;
  std::size_t end = max_bytes;
  while (end > 0 && !BeginsSign(text[end])) --end;
  return text.substr(0, end);
}

std::string ShownUtf8(std::string_view bytes) {
  std::string shown;
  for (const char32_t sign : SignsOf(bytes)) {
    const bool control = sign < 0x20 || (sign >= 0x7F && sign < 0xA0);
    AppendUtf8(shown, control ? U' ' : sign);
  }
  return shown;
}

}  // namespace vm
