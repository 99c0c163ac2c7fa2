#include "vdm/train/recorded_track.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <map>
#include <sstream>

#include "vdm/triphone/phoneme_file.h"
#include "vm_protocol/core/text_file.h"

namespace vdm {
namespace {

constexpr std::size_t kMostInstants = 360'000, kMostRecordings = 10'000;
constexpr std::size_t kMostListBytes = std::size_t{1} << 20, kMostBytes = std::size_t{64} << 20;
constexpr double kShortestStepMs = 1, kLongestStepMs = 100, kStepErrorMs = 0.01;

/// ms, then what MouthTruth holds: the shape, the seal.
std::vector<std::string> Columns() {
  std::vector<std::string> names{"ms"};
  for (std::size_t i = 1; i <= kMouthParameters; ++i) names.push_back("m" + std::to_string(i));
  names.insert(names.end(), {"tongue", "seal"});
  return names;
}

class TableReader {
 public:
  TableReader(const std::string& name, std::string_view text)
      : name_(name), lines_{std::string(text)} {}

  vm::Result<RecordedTrack> Read() {
    if (auto read = Header(); !read) return std::unexpected(read.error());
    std::vector<std::vector<double>> rows;
    while (Next()) {
      if (rows.size() == kMostInstants) return Wrong("at most 360000 instants expected");
      auto row = Row();
      if (!row) return std::unexpected(row.error());
      rows.push_back(std::move(*row));
      if (auto checked = CheckStep(rows); !checked) return std::unexpected(checked.error());
    }
    if (rows.size() < 2) return Wrong("at least two instants expected");
    return TrackOf(rows);
  }

 private:
  std::unexpected<vm::Error> Wrong(const std::string& what) const {
    return vm::Fail(vm::Errc::kBadValue, fmt::format("{}:{}: {}", name_, number_, what));
  }
  bool Next() {
    std::string line;
    do {
      if (!std::getline(lines_, line)) return false;
      ++number_;
      if (line.ends_with('\r')) line.pop_back();
    } while (line.empty());
    cells_.clear();
    std::istringstream cells(line);
    for (std::string cell; std::getline(cells, cell, ',');) cells_.push_back(cell);
    return true;
  }
  vm::Result<void> Header() {
    if (!Next()) return Wrong("no line found");
    for (const std::string& name : Columns()) {
      const auto found = std::ranges::find(cells_, name);
      if (found == cells_.end()) return Wrong("no column '" + name + "' found");
      places_.push_back(static_cast<std::size_t>(found - cells_.begin()));
    }
    return {};
  }
  vm::Result<std::vector<double>> Row() const {
    std::vector<double> row;
    for (const std::size_t place : places_) {
      const std::string cell = place < cells_.size() ? cells_[place] : "";
      double value = 0;
      const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
      if (error != std::errc() || end != cell.data() + cell.size() || !std::isfinite(value)) {
        return Wrong(fmt::format("'{}' found in column {}, a number expected", cell, place + 1));
      }
      row.push_back(value);
    }
    return row;
  }
  vm::Result<void> CheckStep(const std::vector<std::vector<double>>& rows) const {
    if (rows.size() < 2) return {};
    const double step = rows[1][0] - rows[0][0], here = rows.back()[0] - rows[rows.size() - 2][0];
    if (step < kShortestStepMs || step > kLongestStepMs || std::abs(here - step) > kStepErrorMs) {
      return Wrong(
          fmt::format("a step of {:g} ms found, the same of 1 to 100 ms expected in all "
                      "lines",
                      here));
    }
    return {};
  }
  static RecordedTrack TrackOf(const std::vector<std::vector<double>>& rows) {
    const auto size = static_cast<Eigen::Index>(rows.size());
    const auto shape = static_cast<Eigen::Index>(kShapeNumbers);
    RecordedTrack track{.step_ms = rows[1][0] - rows[0][0],
                        .truth = {Eigen::MatrixXf(shape, size), Eigen::VectorXf(size), {}}};
    for (Eigen::Index t = 0; t < size; ++t) {
      const std::vector<double>& row = rows[static_cast<std::size_t>(t)];
      for (Eigen::Index i = 0; i < shape; ++i) {
        track.truth.shape(i, t) = static_cast<float>(row[static_cast<std::size_t>(i) + 1]);
      }
      track.truth.closed[t] = static_cast<float>(row.back());
    }
    return track;
  }

  const std::string name_;
  std::istringstream lines_;
  int number_ = 0;
  std::vector<std::string> cells_;
  std::vector<std::size_t> places_;
};

vm::Result<Recording> ReadRecording(const std::string& phonemes, const std::string& track) {
  auto list = ReadPhonemeFile(phonemes);
  if (!list) return std::unexpected(list.error());
  const auto table = vm::ReadTextFile(track, kMostBytes);
  if (!table) return std::unexpected(table.error());
  auto read = ReadTrack(track, *table);
  if (!read) return std::unexpected(read.error());
  return Recording{std::move(*list), std::move(*read)};
}

}  // namespace

vm::Result<RecordedTrack> ReadTrack(const std::string& name, std::string_view text) {
  return TableReader(name, text).Read();
}

MouthTruth Resampled(const RecordedTrack& track, double step_ms) {
  const Eigen::Index last = track.truth.shape.cols() - 1;
  const double length_ms = track.step_ms * static_cast<double>(last);
  const auto size = static_cast<Eigen::Index>(length_ms / step_ms) + 1;
  MouthTruth out{Eigen::MatrixXf(track.truth.shape.rows(), size), Eigen::VectorXf(size), {}};
  for (Eigen::Index t = 0; t < size; ++t) {
    const double at = static_cast<double>(t) * step_ms / track.step_ms;
    const Eigen::Index before = std::min(static_cast<Eigen::Index>(at), last);
    const Eigen::Index after = std::min(before + 1, last);
    const auto part = static_cast<float>(at - static_cast<double>(before));
    out.shape.col(t) =
        (1 - part) * track.truth.shape.col(before) + part * track.truth.shape.col(after);
    out.closed[t] = (1 - part) * track.truth.closed[before] + part * track.truth.closed[after];
  }
  return out;
}

vm::Result<std::vector<Recording>> ReadRecordings(const std::string& list) {
  const auto text = vm::ReadTextFile(list, kMostListBytes);
  if (!text) return std::unexpected(text.error());
  const auto folder = std::filesystem::path(list).parent_path();
  std::vector<Recording> recordings;
  std::istringstream lines(*text);
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    std::istringstream words(line);
    std::string phonemes, track, more;
    if (!(words >> phonemes) || phonemes.starts_with('#')) continue;
    if (!(words >> track) || words >> more || recordings.size() == kMostRecordings) {
      return vm::Fail(vm::Errc::kBadValue,
                      fmt::format("{}:{}: PHONEMES TRACK expected, at most {} lines", list, number,
                                  kMostRecordings));
    }
    auto recording = ReadRecording(folder / phonemes, folder / track);
    if (!recording) return std::unexpected(recording.error());
    recordings.push_back(std::move(*recording));
  }
  if (recordings.empty()) return vm::Fail(vm::Errc::kBadValue, list + ": no recording found");
  return recordings;
}

}  // namespace vdm
