#pragma once

#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "vm_protocol/core/result.h"

namespace hypermask {

/// The text files of this program: the first line is a heading, then each line is a key and its
/// numbers; blank lines and what follows a # are passed over.
struct KeyLineFormat {
  std::string heading{};  ///< the first line, "hypermask calibration 1"
  struct Key {
    std::size_t numbers = 0;          ///< how many follow it
    std::size_t least = 1, most = 1;  ///< how many lines of it there are
    /// Takes a line's numbers, which are finite and not beyond 1e9; what is wrong with them, or "".
    std::function<std::string(const std::vector<double>&)> take{};
  };
  std::map<std::string, Key, std::less<>> keys{};
};

/// The longest file of this form that is read.
inline constexpr std::size_t kMaxKeyLineBytes = 256u * 1024;

/// Reads `text`, which is the content of the file `name`. Error: kBadValue, "NAME:LINE: what is
/// wrong and what was expected".
vm::Result<void> ReadKeyLines(const std::string& name, std::string_view text,
                              const KeyLineFormat& format);

}  // namespace hypermask
