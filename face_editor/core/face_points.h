#pragma once

#include <glm/vec2.hpp>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "face_editor/core/state.h"
#include "vm_protocol/core/result.h"

namespace editor {

/// For each of the network's points the one on the other side of the face; its own number on the
/// median.
using Mirror = std::vector<int>;
/// From where the points lie on a symmetric head (x to the side, millimetres).
Mirror MirrorOf(std::span<const glm::vec3> places);
/// Only the points that have names, by their names; all others are their own.
Mirror MirrorByName();

/// Points that belong together, right and left being the person's.
struct PointGroup {
  std::string_view name, title;
  std::vector<int> points;
};
const std::vector<PointGroup>& PointGroups();

/// The points people name: corners of eyes and mouth, tip of the nose and the like.
bool IsNamed(int point);
/// "chin", or the number.
std::string PointName(int point);
/// A name, a number or a group. Error: kBadValue listing them.
vm::Result<std::set<int>> PointsNamed(std::string_view word);

/// A move of some points.
struct Drag {
  std::set<int> points;
  glm::vec2 by{};         ///< pixels
  bool symmetric = true;  ///< the other side does the same, mirrored
  float reach = 0;        ///< pixels; what is nearer than this goes along, the less the farther
};
/// Mirrors about the face's own median in the picture, which may be tilted. Points of both sides
/// taken together move as one whole; points of the median stay on it if they are moved alone.
PointMap Dragged(const PointMap& from, const Mirror& mirror, const Drag& drag);

/// The unit direction of the median in the picture, from brow to chin.
glm::vec2 Median(const PointMap& points, const Mirror& mirror);
/// Between the outer corners of the eyes, pixels; 0 if they are not there.
float EyeDistance(const PointMap& points);

/// Where points may be set by hand on a picture in which no face was found: a face of half its
/// height in the middle.
PointMap PlainPoints(int width, int height);

/// The file of points that face_fit --points reads.
std::string WritePoints(const PointMap& points);

}  // namespace editor
