#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "fsm/head/spline.h"
#include "fsm/head/table_reader.h"

namespace fsm {

/// The skin as a smooth surface over a plane domain, before lids and lips are let into it.
/// Domain: `a` sideways from the median (the sign chooses the side), `b` down from the crown; on
/// the front of the face (a, b) is nearly (x, y) in millimetres. Immutable after construction.
class FaceSurface {
 public:
  /// Throws std::runtime_error naming file and line if a table is damaged.
  FaceSurface(const Table& cage, const Table& features);

  glm::vec3 Point(glm::vec2 domain) const;
  /// The point of the front of the face that is seen at (x, y), and its domain coordinates.
  glm::vec3 PointAt(glm::vec2 xy, glm::vec2& domain) const;
  glm::vec3 Normal(glm::vec2 domain) const;

  float last_column() const { return columns_.back(); }

 private:
  struct Bump {
    glm::vec2 at, size, turn;  // turn: cosine, sine
    glm::vec3 by;
  };
  struct Ball {
    glm::vec3 centre, radii;
  };
  glm::vec3 Cage(glm::vec2 domain) const;
  glm::vec3 Bumps(glm::vec2 domain) const;
  float Nose(float x, float y, float z) const;

  std::vector<float> columns_;
  SplineBasis across_;  // mirrored past both ends, so the surface is smooth over the median
  SplineBasis down_;
  std::vector<glm::vec3> cage_;  // rows x columns
  std::vector<Bump> bumps_;
  std::vector<Ball> balls_;
  Curve ridge_z_, ridge_width_;
};

}  // namespace fsm
