#pragma once

#include <string>
#include <string_view>

#include "vm_protocol/core/result.h"

namespace vm {

/// The character encoding at the edge of a stream; inside everything is UTF-8. kShiftJis is CP932.
enum class Encoding { kUtf8, kEucJp, kShiftJis };

/// "utf-8", "euc-jp", "shift_jis", any case. Error: kBadValue naming the three.
Result<Encoding> ParseEncoding(std::string_view name);
/// Error: kBadUtf8 (any invalid sequence), with the column.
Result<std::string> ToUtf8(std::string_view text, Encoding encoding);
/// Characters that do not exist there become '?'.
std::string FromUtf8(std::string_view text, Encoding encoding);

/// Which of the original's encodings a line is in that is not UTF-8; kUtf8 if it fits none.
/// It must convert as a whole and hold no control characters beyond ASCII. If it fits both, it is
/// the one that yields fewer half-width kana (each byte of EUC-JP's kana is one in Shift_JIS), then
/// the one that yields more kana, then EUC-JP, which the original spoke.
Encoding RecogniseEncoding(std::string_view line);

/// What one peer speaks. One declared as UTF-8 that sends a line of another encoding is taken to
/// speak that from then on; one that has sent UTF-8 beyond ASCII never is.
class PeerEncoding {
 public:
  explicit PeerEncoding(Encoding declared)
      : encoding_(declared), settled_(declared != Encoding::kUtf8) {}
  /// True if the line can be taken as it is.
  bool IsPlain(std::string_view line);
  /// Error: kBadUtf8, with the column.
  Result<std::string> Read(std::string_view line) const { return ToUtf8(line, encoding_); }
  Encoding encoding() const { return encoding_; }

 private:
  Encoding encoding_;
  bool settled_;
};

}  // namespace vm
