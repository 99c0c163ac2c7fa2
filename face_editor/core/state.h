#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "face_editor/core/unit_rows.h"
#include "fsm/motion/inputs/expression_table.h"
#include "fsm/motion/inputs/motion_patterns.h"
#include "fsm/motion/inputs/viseme_tables.h"

namespace editor {

/// Points of the landmark network (0..467) on the photo: x and y in pixels, y down; z in the same
/// unit towards the viewer.
using PointMap = std::map<int, glm::vec3>;
/// Movements of the head by kind (NOD REFUSE LISTEN USERDEF); pattern n is element n - 1.
using HeadCurves = std::map<std::string, std::vector<fsm::HeadCurve>, std::less<>>;
using Sliders = std::map<std::string, float, std::less<>>;

/// What is edited; each part is kept in a file of its own.
enum class Part : std::size_t { kPoints, kLook, kExpressions, kMouth, kMotions, kIdentity, kUnits };
inline constexpr std::size_t kParts = 7;

/// Everything that can be edited, at one instant. A plain value.
struct State {
  PointMap points;
  fsm::FaceLook look;  ///< units as they are set on the face now
  fsm::ExpressionTable expressions;
  fsm::Visemes shapes14, shapes28;
  HeadCurves curves;
  std::shared_ptr<const Units> units;  ///< how far each moves which skin; never nullptr
  std::string base = "galatea";        ///< the built-in face whose sliders are moved
  Sliders sliders;
  /// Differs whenever a part does: cheap to compare.
  std::array<std::uint64_t, kParts> version{};
};

}  // namespace editor
