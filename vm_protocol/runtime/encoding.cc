#include "vm_protocol/runtime/encoding.h"

#include <iconv.h>

#include <algorithm>
#include <cerrno>
#include <memory>
#include <stdexcept>

#include "vm_protocol/core/utf8.h"

namespace vm {
namespace {

const char* IconvName(Encoding encoding) {
  switch (encoding) {
    case Encoding::kUtf8:
      return "UTF-8";
    case Encoding::kEucJp:
      return "EUC-JP";
    case Encoding::kShiftJis:
      return "SHIFT_JIS";
  }
  return "UTF-8";
}

/// Owns one iconv conversion.
class Converter {
 public:
  Converter(Encoding to, Encoding from) : handle_(iconv_open(IconvName(to), IconvName(from))) {
    if (handle_ == reinterpret_cast<iconv_t>(-1)) {
      throw std::runtime_error("the system's iconv lacks an encoding (EUC-JP or Shift_JIS)");
    }
  }
  ~Converter() { iconv_close(handle_); }
  Converter(const Converter&) = delete;
  Converter& operator=(const Converter&) = delete;

  /// Calls `on_bad(rest)` at a sequence that cannot be converted; it returns how many bytes of the
  /// rest to skip (after appending what it likes to `out`), or 0 to give up.
  template <typename OnBad>
  bool Convert(std::string_view text, std::string& out, const OnBad& on_bad) {
    std::string input(text);
    char* in = input.data();
    std::size_t in_left = input.size();
    char buffer[1024];
    while (in_left > 0) {
      char* to = buffer;
      std::size_t to_left = sizeof(buffer);
      const std::size_t result = iconv(handle_, &in, &in_left, &to, &to_left);
      out.append(buffer, sizeof(buffer) - to_left);
      if (result != static_cast<std::size_t>(-1) || errno == E2BIG) continue;
      const std::size_t skip = on_bad(std::string_view(in, in_left));
      if (skip == 0) return false;
      in += skip;
      in_left -= skip;
    }
    return true;
  }

 private:
  iconv_t handle_;
};

}  // namespace

Result<Encoding> ParseEncoding(std::string_view name) {
  std::string lower(name);
  std::ranges::transform(lower, lower.begin(), [](char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c == '_' ? '-' : c;
  });
  if (lower == "utf-8" || lower == "utf8") return Encoding::kUtf8;
  if (lower == "euc-jp" || lower == "eucjp") return Encoding::kEucJp;
  if (lower == "shift-jis" || lower == "sjis") return Encoding::kShiftJis;
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
  std::string out;
  std::size_t bad_at = 0;
  const bool good =
      Converter(Encoding::kUtf8, encoding).Convert(text, out, [&](std::string_view rest) {
        bad_at = text.size() - rest.size() + 1;
        return std::size_t{0};
      });
  if (!good) {
    return Fail(Errc::kBadUtf8, std::string("found a byte that is not ") + IconvName(encoding),
                bad_at);
  }
  return out;
}

std::string FromUtf8(std::string_view text, Encoding encoding) {
  if (encoding == Encoding::kUtf8) return std::string(text);
  std::string out;
  Converter(encoding, Encoding::kUtf8).Convert(text, out, [&](std::string_view rest) {
    out += '?';
    std::size_t skip = 1;
    while (skip < rest.size() && (static_cast<unsigned char>(rest[skip]) & 0xC0) == 0x80) ++skip;
    return skip;
  });
  return out;
}

}  // namespace vm
