#include "face_space/record/track.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <set>

#include "fsm/base/parse_number.h"
#include "fsm/base/table_reader.h"
#include "vm_protocol/core/blanks.h"
#include "vm_protocol/core/lower_case.h"
#include "vm_protocol/core/text_file.h"

namespace facespace {
namespace {

/// A column of time and how many ms one of it is.
struct TimeName {
  std::string_view name;
  double ms;
};
constexpr std::array<TimeName, 5> kTimeNames{
    {{"ms", 1}, {"time_ms", 1}, {"time", 1000}, {"t", 1000}, {"seconds", 1000}}};

std::string Shown(std::string_view word) { return fsm::Printable(std::string(word.substr(0, 40))); }

/// Collects frames and checks what all kinds of text have in common.
class Frames {
 public:
  Frames(const std::string& name, const TrackFormat& format) : format_(format) {
    track_.name = name;
  }

  vm::Result<void> SetColumns(std::vector<std::string> names) {
    if (names.size() > kMostColumns) {
      return vm::Fail(vm::Errc::kLimit, fmt::format("{}: {} columns found, at most {} are read",
                                                    track_.name, names.size(), kMostColumns));
    }
    std::set<std::string> seen;
    for (const std::string& name : names) {
      if (!seen.insert(name).second)
        return Wrong(fmt::format("column '{}' is there twice", Shown(name)));
    }
    names_ = std::move(names);
    for (std::size_t i = 0; i < names_.size(); ++i) {
      const std::string small = vm::LowerCase(names_[i]);
      for (const TimeName& time : kTimeNames) {
        if (small == time.name && !time_) time_ = {i, time.ms};
      }
      if (small == "person") person_ = i;
    }
    if (!time_ && !format_.rate) {
      return Wrong(
          "no column of time found (ms, or time in seconds); say the frames a second by "
          "--rate");
    }
    return {};
  }

  /// `cells`: a word for each column.
  vm::Result<void> Add(int line, std::span<const std::string_view> cells) {
    line_ = line;
    if (cells.size() != names_.size()) {
      return Wrong(fmt::format("{} columns found, {} expected", cells.size(), names_.size()));
    }
    if (person_ && vm::Trimmed(cells[*person_]) == "0") return {};
    if (numbers_.size() + cells.size() > kMostNumbers) {
      return vm::Fail(vm::Errc::kLimit,
                      fmt::format("{}:{}: more than {} numbers", track_.name, line, kMostNumbers));
    }
    // Columns of words (a timecode, a name of a take) are known by the first frame.
    if (kept_.empty()) {
      for (std::size_t i = 0; i < cells.size(); ++i) {
        const std::string_view cell = vm::Trimmed(cells[i]);
        const bool word = !fsm::ParseNumber(cell) && !cell.empty() &&
                          vm::LowerCase(cell) != "nan" && vm::LowerCase(cell) != "inf" &&
                          vm::LowerCase(cell) != "-nan" && vm::LowerCase(cell) != "-inf";
        kept_.push_back(!word);
      }
    }
    double ms = format_.rate ? 1000.0 * static_cast<double>(track_.ms.size()) / *format_.rate : 0;
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const bool is_time = time_ && i == time_->column;
      if (!kept_[i] && !is_time) continue;
      const auto number = fsm::ParseNumber(vm::Trimmed(cells[i]));
      if (!number || std::abs(*number) > 1e9) {
        return Wrong(fmt::format("column '{}': '{}' found, a number expected", Shown(names_[i]),
                                 Shown(vm::Trimmed(cells[i]))));
      }
      if (is_time) {
        ms = *number * time_->ms;
      } else {
        numbers_.push_back(*number);
      }
    }
    if (!track_.ms.empty() && ms <= track_.ms.back()) {
      return Wrong(fmt::format("time {:g} ms found after {:g} ms; rising times expected", ms,
                               track_.ms.back()));
    }
    track_.ms.push_back(ms);
    return {};
  }

  vm::Result<Track> Finish() {
    if (track_.ms.size() < 2) {
      return vm::Fail(vm::Errc::kBadValue, fmt::format("{}: {} frames found, at least 2 expected",
                                                       track_.name, track_.ms.size()));
    }
    for (std::size_t i = 0; i < names_.size(); ++i) {
      if (kept_[i] && !(time_ && i == time_->column)) track_.columns.push_back(names_[i]);
    }
    const auto rows = static_cast<Eigen::Index>(track_.columns.size());
    track_.values =
        Eigen::MatrixXd::Map(numbers_.data(), rows, static_cast<Eigen::Index>(track_.ms.size()));
    return std::move(track_);
  }

  std::unexpected<vm::Error> Wrong(const std::string& what) const {
    return vm::Fail(vm::Errc::kBadValue, fmt::format("{}:{}: {}", track_.name, line_, what));
  }
  void SetLine(int line) { line_ = line; }
  bool has_columns() const { return !names_.empty(); }
  const std::vector<std::string>& names() const { return names_; }

 private:
  struct TimeColumn {
    std::size_t column;
    double ms;
  };
  const TrackFormat format_;
  Track track_;
  int line_ = 1;
  std::vector<std::string> names_;
  std::vector<bool> kept_;
  std::optional<TimeColumn> time_;
  std::optional<std::size_t> person_;
  std::vector<double> numbers_;
};

std::vector<std::string_view> CellsOf(std::string_view line, char separator) {
  std::vector<std::string_view> cells;
  for (std::size_t at = 0;;) {
    const std::size_t end = std::min(line.find(separator, at), line.size());
    cells.push_back(line.substr(at, end - at));
    if (end == line.size() || cells.size() > kMostColumns) return cells;
    at = end + 1;
  }
}

vm::Result<void> AddCsv(Frames& frames, int number, std::string_view line, char& separator) {
  if (frames.has_columns()) return frames.Add(number, CellsOf(line, separator));
  separator = line.find('\t') != line.npos ? '\t' : line.find(';') != line.npos ? ';' : ',';
  std::vector<std::string> names;
  for (const std::string_view cell : CellsOf(line, separator)) {
    names.emplace_back(vm::Trimmed(vm::Trimmed(cell), "\""));
  }
  return frames.SetColumns(std::move(names));
}

/// The members of an object as names and words of columns; points as x0, y0, z0, ...
vm::Result<void> AddJson(Frames& frames, int number, std::string_view line) {
  frames.SetLine(number);
  const auto object = nlohmann::json::parse(line, nullptr, false);
  if (!object.is_object()) return frames.Wrong("a JSON object expected");
  if (const auto person = object.find("person"); person != object.end() && *person == 0) return {};
  std::vector<std::string> names, words;
  for (const auto& [key, value] : object.items()) {
    if (value.is_number()) {
      names.push_back(key);
      words.push_back(value.dump());
    } else if (key == "points" && value.is_array()) {
      for (std::size_t i = 0; i < value.size(); ++i) {
        if (!value[i].is_array() || value[i].size() != 3 || names.size() > kMostColumns) {
          return frames.Wrong("points that are no triples found");
        }
        for (std::size_t k = 0; k < 3; ++k) {
          names.push_back(fmt::format("{}{}", "xyz"[k], i));
          words.push_back(value[i][k].is_number() ? value[i][k].dump() : "");
        }
      }
    } else if (!value.is_string()) {
      return frames.Wrong(fmt::format("'{}': a number expected", Shown(key)));
    }
  }
  if (!frames.has_columns()) {
    if (auto set = frames.SetColumns(names); !set) return set;
  } else if (names != frames.names()) {
    return frames.Wrong(fmt::format("{} numbers found, the {} of the first frame expected",
                                    names.size(), frames.names().size()));
  }
  return frames.Add(number, std::vector<std::string_view>(words.begin(), words.end()));
}

}  // namespace

std::optional<Eigen::Index> Track::Find(std::string_view column) const {
  const auto found = std::ranges::find(columns, column);
  if (found == columns.end()) return std::nullopt;
  return found - columns.begin();
}

vm::Result<Track> ParseTrack(const std::string& name, std::string_view text,
                             const TrackFormat& format) {
  Frames frames(name, format);
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  const bool json = vm::Trimmed(text, " \t\r\n").starts_with('{');
  char separator = ',';
  int number = 0;
  while (!text.empty()) {
    const std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(line.size() + 1, text.size()));
    ++number;
    if (vm::Trimmed(line).empty()) continue;
    const auto added = json ? AddJson(frames, number, line)
                            : AddCsv(frames, number, vm::Trimmed(line, "\r"), separator);
    if (!added) return std::unexpected(added.error());
  }
  return frames.Finish();
}

vm::Result<Track> ReadTrack(const std::string& path, const TrackFormat& format) {
  const auto text = vm::ReadTextFile(path, kMostTrackBytes);
  if (!text) return std::unexpected(text.error());
  return ParseTrack(path, *text, format);
}

}  // namespace facespace
