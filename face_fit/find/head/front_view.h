#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <vector>

#include "face_fit/find/head/mesh_point.h"
#include "fsm/rig/head.h"

namespace facefit {

/// What lies foremost in a window before a head that looks to +z: cells of an eighth of a
/// millimetre, columns to the viewer's right, rows upward. Hair and lashes are seen through.
class FrontView {
 public:
  static constexpr float kCell = 0.125F;
  static constexpr std::uint32_t kNone = 0xffffffffU;
  /// Both outlive it. Millimetres; at most 200 to a side.
  FrontView(const fsm::HeadTopology& topology, std::span<const glm::vec3> position, glm::vec2 low,
            glm::vec2 high);

  int columns() const { return columns_; }
  int rows() const { return rows_; }
  /// Where in topology.indices the triangle in a cell begins; kNone outside the window too.
  std::uint32_t Triangle(int column, int row) const;
  glm::vec2 Centre(int column, int row) const {
    return low_ + kCell * (glm::vec2(column, row) + 0.5F);
  }
  /// REQUIRES: a triangle there.
  MeshPoint Place(int column, int row) const;

 private:
  void Draw(std::uint32_t first);
  std::size_t At(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
           static_cast<std::size_t>(column);
  }

  const fsm::HeadTopology& topology_;
  std::span<const glm::vec3> position_;
  glm::vec2 low_;
  int columns_, rows_;
  std::vector<float> z_;
  std::vector<std::uint32_t> first_;
};

}  // namespace facefit
