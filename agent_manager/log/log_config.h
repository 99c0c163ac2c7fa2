#pragma once

#include <cstdint>
#include <string>

namespace am {

/// Where the session log is kept and how much of it.
struct LogConfig {
  std::string file;             ///< empty: none
  std::uint64_t rotate_mb = 0;  ///< a new file beyond so many MiB; 0 = never
  unsigned keep = 10;           ///< older files: FILE.1.gz (newest) to FILE.<keep>.gz
  bool operator==(const LogConfig&) const = default;
};

}  // namespace am
