#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "vm_protocol/core/result.h"

namespace facespace {

/// A recording as it is written: named columns of numbers over time. A plain value.
struct Track {
  std::string name;                  ///< of the file, for messages
  std::vector<std::string> columns;  ///< without the time
  std::vector<double> ms;            ///< rising
  Eigen::MatrixXd values;            ///< columns x frames

  std::optional<Eigen::Index> Find(std::string_view column) const;
};

struct TrackFormat {
  std::optional<double> rate;  ///< frames a second, where a recording has no column of time
};

inline constexpr std::size_t kMostTrackBytes = std::size_t{256} << 20;
inline constexpr std::size_t kMostColumns = 6000, kMostNumbers = 40'000'000;

/// Reads CSV (a line of names, then one a frame; commas, semicolons or tabs) or JSON lines (an
/// object a frame; `points` of face_track become x0, y0, z0, x1, ...). The time is a column `ms` or
/// `time_ms`, or in seconds `time`, `t` or `seconds`. Frames in which face_track saw no face
/// (`person` 0) are left out. Columns that hold words in place of numbers throughout are left out,
/// too. Errors: kBadValue "NAME:LINE: ..." for a frame of another number of columns, a word or
/// nothing where a number is expected, numbers that are not finite, times that do not rise, fewer
/// than 2 frames; kLimit beyond kMostColumns or kMostNumbers; kTooLong beyond kMostTrackBytes.
vm::Result<Track> ParseTrack(const std::string& name, std::string_view text,
                             const TrackFormat& format = {});
/// The same of a file; also the errors of vm::ReadTextFile.
vm::Result<Track> ReadTrack(const std::string& path, const TrackFormat& format = {});

}  // namespace facespace
