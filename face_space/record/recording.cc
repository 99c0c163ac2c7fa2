#include "face_space/record/recording.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <map>

#include "fsm/base/table_reader.h"
#include "vm_protocol/core/lower_case.h"

namespace facespace {
namespace {

/// The marker and the axis a column is of; nothing for other columns.
struct Place {
  std::string marker;
  std::size_t axis;
};
std::optional<std::size_t> AxisOf(char letter) {
  const char small = vm::LowerCase(letter);
  if (small < 'x' || small > 'z') return std::nullopt;
  return static_cast<std::size_t>(small - 'x');
}
std::optional<Place> PlaceOf(const std::string& column) {
  if (column.size() < 2) return std::nullopt;
  const auto before = std::string_view("_.: ").find(column[column.size() - 2]);
  if (before != std::string_view::npos && column.size() > 2) {
    if (const auto axis = AxisOf(column.back())) {
      return Place{column.substr(0, column.size() - 2), *axis};
    }
  }
  const bool number = std::ranges::all_of(std::string_view(column).substr(1), [](char c) {
    return std::isdigit(static_cast<unsigned char>(c)) != 0;
  });
  if (const auto axis = AxisOf(column[0]); axis && number) return Place{column.substr(1), *axis};
  return std::nullopt;
}

}  // namespace

bool HasMarkers(const Track& track) {
  return std::ranges::any_of(track.columns,
                             [](const std::string& c) { return PlaceOf(c).has_value(); });
}

vm::Result<Recording> MarkersOf(const Track& track, double mm) {
  Recording out{.name = track.name, .markers = {}, .ms = track.ms, .places = {}};
  std::map<std::string, std::array<Eigen::Index, 3>, std::less<>> found;
  for (std::size_t i = 0; i < track.columns.size(); ++i) {
    const auto place = PlaceOf(track.columns[i]);
    if (!place) continue;
    const auto [at, fresh] =
        found.try_emplace(place->marker, std::array<Eigen::Index, 3>{-1, -1, -1});
    if (fresh) out.markers.push_back(place->marker);
    at->second[place->axis] = static_cast<Eigen::Index>(i);
  }
  const auto count = static_cast<Eigen::Index>(out.markers.size());
  if (count < kFewestMarkers || count > kMostMarkers) {
    return vm::Fail(
        vm::Errc::kBadValue,
        fmt::format("{}: {} markers found (columns NAME_x, NAME_y, NAME_z), {} to {} expected",
                    track.name, count, kFewestMarkers, kMostMarkers));
  }
  out.places.resize(3 * count, track.values.cols());
  for (Eigen::Index m = 0; m < count; ++m) {
    const std::string& marker = out.markers[static_cast<std::size_t>(m)];
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const Eigen::Index row = found.find(marker)->second[axis];
      if (row < 0) {
        return vm::Fail(vm::Errc::kBadValue,
                        fmt::format("{}: marker '{}' has no column of its {}", track.name,
                                    fsm::Printable(marker.substr(0, 40)), "xyz"[axis]));
      }
      out.places.row(3 * m + static_cast<Eigen::Index>(axis)) = mm * track.values.row(row);
    }
  }
  return out;
}

vm::Result<void> OrderAs(const Recording& first, Recording& recording) {
  if (first.markers == recording.markers) return {};
  if (first.count() != recording.count()) {
    return vm::Fail(vm::Errc::kBadValue,
                    fmt::format("{}: {} markers found, the {} of {} expected", recording.name,
                                recording.count(), first.count(), first.name));
  }
  std::map<std::string_view, Eigen::Index> at;
  for (std::size_t m = 0; m < recording.markers.size(); ++m) {
    at[recording.markers[m]] = static_cast<Eigen::Index>(m);
  }
  Eigen::MatrixXd ordered(recording.places.rows(), recording.places.cols());
  for (std::size_t m = 0; m < first.markers.size(); ++m) {
    const auto found = at.find(first.markers[m]);
    if (found == at.end()) {
      return vm::Fail(vm::Errc::kBadValue,
                      fmt::format("{}: there is no marker '{}', which {} has", recording.name,
                                  fsm::Printable(first.markers[m].substr(0, 40)), first.name));
    }
    ordered.middleRows<3>(3 * static_cast<Eigen::Index>(m)) =
        recording.places.middleRows<3>(3 * found->second);
  }
  recording.places = std::move(ordered);
  recording.markers = first.markers;
  return {};
}

}  // namespace facespace
