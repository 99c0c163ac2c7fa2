#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "face_fit/image/raster.h"
#include "face_fit/surface/mesh_point.h"
#include "face_fit/surface/triangles.h"
#include "fsm/rig/head.h"

namespace facefit {

/// Points at even steps on a plane, in any unit.
struct SampleGrid {
  glm::vec2 origin;  ///< the first point
  float step;
  int columns, rows;
  glm::vec2 Point(int column, int row) const { return origin + step * glm::vec2(column, row); }
};

/// What is foremost at a point of a grid.
struct SurfaceSample {
  MeshTriangle triangle;
  glm::vec3 weights{0};  ///< of the triangle's corners
  MeshPoint OnMesh() const { return {triangle.corner, weights}; }
};

/// A run of columns of a grid.
struct Columns {
  int first, last;
};

/// A depth buffer: keeps at each point of a grid the foremost point of the triangles drawn.
class VisibleSurface {
 public:
  static constexpr float kNothing = -1e9F;  ///< the depth where nothing was drawn
  /// Whether the second coordinate of the grid's plane points up; that of an image points down.
  enum class Upward { kNo, kYes };
  /// `screen`: for each vertex x and y in the grid's plane, z towards the viewer.
  VisibleSurface(const SampleGrid& grid, std::vector<glm::vec3> screen,
                 Upward upward = Upward::kNo);
  /// Draws a triangle of either orientation.
  void Draw(const MeshTriangle& triangle);
  /// Draws a triangle unless it is seen from behind.
  void DrawFront(const MeshTriangle& triangle);

  const SampleGrid& grid() const { return grid_; }
  const FloatImage& depth() const { return depth_; }
  /// Returns 1 where something was drawn, else 0.
  Mask Covered() const;
  /// Returns what was drawn at a point; nullptr where nothing was and outside the grid. Valid until
  /// the next Draw and as long as this object.
  const SurfaceSample* SampleAt(int column, int row) const;

 private:
  SampleGrid grid_;
  std::vector<glm::vec3> screen_;
  float front_sign_;  ///< of the area of triangles that face the viewer
  FloatImage depth_;
  std::vector<SurfaceSample> samples_;
};

/// Returns the skin that is seen from the front. `screen`: as for VisibleSurface.
VisibleSurface DrawSkin(const fsm::HeadSurface& mesh, std::vector<glm::vec3> screen,
                        const SampleGrid& grid);

inline constexpr float kFrontStepMm = 0.125F;
/// Returns the front view of a head that faces +z, in the window low..high, in steps of
/// kFrontStepMm, rows upward, without hair and lashes. Millimetres; at most 200 to a side.
VisibleSurface VisibleFromFront(const fsm::HeadSurface& mesh,
                                const std::vector<glm::vec3>& position, glm::vec2 low,
                                glm::vec2 high);

}  // namespace facefit
