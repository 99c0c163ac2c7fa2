#include "vm_protocol/runtime/encoding.h"

#include <algorithm>

#include "vm_protocol/core/charset.h"
#include "vm_protocol/core/lower_case.h"
#include "vm_protocol/core/utf8.h"

namespace vm {
namespace {

const char* CharsetOf(Encoding encoding) {
  return encoding == Encoding::kEucJp      ? "EUC-JP"
         : encoding == Encoding::kShiftJis ? "CP932"
                                           : "UTF-8";
}

/// What speaks for and against a reading of a line.
struct Reading {
  bool fits = false;
  int half_width = 0;  // kana of half the width
  int kana = 0;
};

Reading Read(std::string_view line, Encoding encoding) {
  const auto text = ToUtf8(line, encoding);
  Reading reading{.fits = text.has_value()};
  if (!text) return reading;
  for (std::size_t at = 0; at < text->size();) {
    const CodePoint sign = DecodeUtf8(*text, at).value_or(CodePoint{0, 1});
    at += sign.length;
    // iconv reads bytes that begin no character of EUC-JP as control characters.
    if (sign.value >= 0x80 && sign.value < 0xA0) reading.fits = false;
    if (sign.value >= 0xFF61 && sign.value <= 0xFF9F) ++reading.half_width;
    if (sign.value >= 0x3040 && sign.value <= 0x30FF) ++reading.kana;
  }
  return reading;
}

}  // namespace

Result<Encoding> ParseEncoding(std::string_view name) {
  std::string lower = LowerCase(name);
  std::ranges::replace(lower, '_', '-');
  if (lower == "utf-8" || lower == "utf8") return Encoding::kUtf8;
  if (lower == "euc-jp" || lower == "eucjp") return Encoding::kEucJp;
  if (lower == "shift-jis" || lower == "sjis" || lower == "cp932") return Encoding::kShiftJis;
  return Fail(Errc::kBadValue,
              "found encoding '" + std::string(name) + "', expected utf-8, euc-jp or shift_jis");
}

Result<std::string> ToUtf8(std::string_view text, Encoding encoding) {
  if (encoding == Encoding::kUtf8) {
    if (const auto bad = FirstBadUtf8(text)) {
      return Fail(Errc::kBadUtf8, "found a byte that is not UTF-8, expected UTF-8 text", *bad + 1);
    }
    return std::string(text);
  }
  return DecodeCharset(text, CharsetOf(encoding));
}

std::string FromUtf8(std::string_view text, Encoding encoding) {
  if (encoding == Encoding::kUtf8) return std::string(text);
  return EncodeCharset(text, CharsetOf(encoding)).value_or(std::string(text));
}

Encoding RecogniseEncoding(std::string_view line) {
  const Reading euc = Read(line, Encoding::kEucJp);
  const Reading sjis = Read(line, Encoding::kShiftJis);
  if (!euc.fits && !sjis.fits) return Encoding::kUtf8;
  if (euc.fits != sjis.fits) return euc.fits ? Encoding::kEucJp : Encoding::kShiftJis;
  const bool is_euc =
      euc.half_width != sjis.half_width ? euc.half_width < sjis.half_width : euc.kana >= sjis.kana;
  return is_euc ? Encoding::kEucJp : Encoding::kShiftJis;
}

bool PeerEncoding::IsPlain(std::string_view line) {
  if (encoding_ != Encoding::kUtf8) return false;
  if (settled_ || AsciiPrefix(line) == line.size()) return true;
  const bool is_utf8 = !FirstBadUtf8(line);
  if (!is_utf8) encoding_ = RecogniseEncoding(line);
  settled_ = is_utf8 || encoding_ != Encoding::kUtf8;
  return encoding_ == Encoding::kUtf8;
}

}  // namespace vm
