#include "vm_protocol/core/charset.h"

#include <iconv.h>

#include <algorithm>
#include <cerrno>

#include "vm_protocol/core/lower_case.h"
#include "vm_protocol/core/utf8.h"

namespace vm {
namespace {

std::string SystemName(const std::string& charset) {
  std::string lower = LowerCase(charset);
  std::ranges::replace(lower, '_', '-');
  const bool shift_jis = lower == "shift-jis" || lower == "sjis" || lower == "x-sjis" ||
                         lower == "windows-31j" || lower == "ms-kanji";
  return shift_jis ? "CP932" : charset;
}

/// Owns one iconv conversion.
class Converter {
 public:
  Converter(const std::string& to, const std::string& from)
      : handle_(iconv_open(to.c_str(), from.c_str())) {}
  ~Converter() {
    if (known()) iconv_close(handle_);
  }
  Converter(const Converter&) = delete;
  bool known() const { return handle_ != reinterpret_cast<iconv_t>(-1); }

  /// Converts up to the end or the first sequence that cannot be converted; says how many bytes of
  /// `text` that took.
  std::size_t Convert(std::string_view text, std::string& out) {
    // iconv takes its input as char*, but does not write there.
    char* in = const_cast<char*>(text.data());
    std::size_t left = text.size();
    bool more = true;
    while (more) {
      char buffer[4096];
      char* to = buffer;
      std::size_t room = sizeof(buffer);
      // Without input it writes what returns a set with states (ISO-2022-JP) to its first.
      const bool ending = left == 0;
      const std::size_t result = ending ? iconv(handle_, nullptr, nullptr, &to, &room)
                                        : iconv(handle_, &in, &left, &to, &room);
      out.append(buffer, sizeof(buffer) - room);
      const bool failed = result == static_cast<std::size_t>(-1);
      more = failed ? errno == E2BIG : !ending;
    }
    return text.size() - left;
  }

 private:
  iconv_t handle_;
};

std::unexpected<Error> Unknown(const std::string& charset) {
  return Fail(Errc::kBadValue, "nobody here knows the encoding '" + charset + "'");
}

}  // namespace

Result<std::string> DecodeCharset(std::string_view bytes, const std::string& charset) {
  Converter converter("UTF-8", SystemName(charset));
  if (!converter.known()) return Unknown(charset);
  std::string out;
  const std::size_t done = converter.Convert(bytes, out);
  if (done == bytes.size()) return out;
  return Fail(Errc::kBadUtf8, "found a byte that is not " + charset, done + 1);
}

Result<std::string> EncodeCharset(std::string_view text, const std::string& charset) {
  Converter converter(SystemName(charset), "UTF-8");
  if (!converter.known()) return Unknown(charset);
  std::string out;
  while (true) {
    text.remove_prefix(converter.Convert(text, out));
    if (text.empty()) return out;
    converter.Convert("?", out);
    do {  // the rest of the character that is not there
      text.remove_prefix(1);
    } while (!text.empty() && !BeginsSign(text.front()));
  }
}

}  // namespace vm
