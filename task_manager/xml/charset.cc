#include <iconv.h>

#include <cerrno>

#include "task_manager/xml/parser.h"

namespace vxml::xml {
namespace {

class Converter {
 public:
  Converter(const std::string& to, const std::string& from)
      : handle_(iconv_open(to.c_str(), from.c_str())) {}
  ~Converter() {
    if (ok()) iconv_close(handle_);
  }
  Converter(const Converter&) = delete;
  Converter& operator=(const Converter&) = delete;
  bool ok() const { return handle_ != reinterpret_cast<iconv_t>(-1); }

  /// Converts all of `text`; `on_bad` is asked at a bad sequence and says whether to go on with
  /// '?'.
  bool Run(std::string_view text, bool replace_bad, std::string& out) {
    std::string input(text);
    char* in = input.data();
    std::size_t left = input.size();
    char buffer[4096];
    while (left > 0) {
      char* to = buffer;
      std::size_t room = sizeof buffer;
      const std::size_t done = iconv(handle_, &in, &left, &to, &room);
      out.append(buffer, sizeof buffer - room);
      if (done != static_cast<std::size_t>(-1) || errno == E2BIG) continue;
      if (!replace_bad) {
        bad_at_ = input.size() - left;
        return false;
      }
      out += '?';
      do {  // the rest of the UTF-8 character
        ++in;
        --left;
      } while (left > 0 && (static_cast<unsigned char>(*in) & 0xC0U) == 0x80U);
    }
    return true;
  }
  std::size_t bad_at() const { return bad_at_; }

 private:
  iconv_t handle_;
  std::size_t bad_at_ = 0;
};

/// Shift_JIS as written on PCs holds characters only its superset CP932 knows.
std::string SystemName(const std::string& charset) {
  if (charset == "shift_jis" || charset == "shift-jis" || charset == "sjis") return "CP932";
  return charset;
}

}  // namespace

vm::Result<std::string> ToUtf8(std::string_view bytes, const std::string& charset) {
  Converter converter("UTF-8", SystemName(charset));
  if (!converter.ok()) return vm::Fail(vm::Errc::kBadValue, "unknown encoding '" + charset + "'");
  std::string out;
  if (!converter.Run(bytes, false, out)) {
    return vm::Fail(vm::Errc::kBadUtf8,
                    "byte " + std::to_string(converter.bad_at() + 1) + " is not " + charset);
  }
  return out;
}

std::string FromUtf8(std::string_view text, const std::string& charset) {
  Converter converter(SystemName(charset), "UTF-8");
  if (!converter.ok()) return std::string(text);
  std::string out;
  converter.Run(text, true, out);
  return out;
}

}  // namespace vxml::xml
