#include "face_space/record/unit_track.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "vm_protocol/core/lower_case.h"

namespace facespace {
namespace {

/// What a column adds to a look at full strength; nothing for other columns.
std::optional<fsm::FaceLook> LookOf(const std::string& column, const fsm::MotionTables& tables) {
  std::string shape = column;
  if (!shape.empty()) shape[0] = vm::LowerCase(shape[0]);
  if (const auto found = tables.blend_shapes.find(shape); found != tables.blend_shapes.end()) {
    return found->second;
  }
  if (!shape.starts_with("au") || shape.size() < 3) return std::nullopt;
  const auto unit = fsm::ParseUnitName(shape.substr(2), tables.unit_names);
  if (!unit) return std::nullopt;
  fsm::FaceLook look;
  const auto number = static_cast<std::size_t>(unit->number);
  for (const fsm::Side side : fsm::kSides) {
    if (unit->sides[side]) look.au[side][number] = 1;
  }
  return look;
}

}  // namespace

bool HasUnits(const Track& track, const fsm::MotionTables& tables) {
  return std::ranges::any_of(track.columns,
                             [&](const std::string& c) { return LookOf(c, tables).has_value(); });
}

vm::Result<UnitTrack> UnitsOf(const Track& track, const fsm::MotionTables& tables) {
  UnitTrack out{.name = track.name, .ms = track.ms, .looks = {}};
  std::vector<std::pair<Eigen::Index, fsm::FaceLook>> parts;
  for (std::size_t i = 0; i < track.columns.size(); ++i) {
    if (const auto look = LookOf(track.columns[i], tables)) {
      parts.emplace_back(static_cast<Eigen::Index>(i), *look);
    }
  }
  if (parts.empty()) {
    return vm::Fail(
        vm::Errc::kBadValue,
        fmt::format("{}: no units found (columns au12L or ARKit's shapes as jawOpen)", track.name));
  }
  for (Eigen::Index t = 0; t < track.values.cols(); ++t) {
    fsm::FaceLook& look = out.looks.emplace_back();
    for (const auto& [row, part] : parts) {
      fsm::AddTo(look, part, std::clamp(track.values(row, t), 0.0, 2.0));
    }
  }
  return out;
}

}  // namespace facespace
