#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <map>
#include <vector>

#include "fsm/render/draw_order.h"
#include "fsm/render/gl_functions.h"
#include "fsm/render/head_description.h"
#include "fsm/render/vertex_attributes.h"
#include "fsm/rig/head.h"

namespace fsm {

/// The vertices and triangles of one head in GL: constant data is uploaded on construction,
/// positions and normals every frame. Destroy while its context is current.
class HeadVertexArrays {
 public:
  /// `rest`: the head's vertices at rest. `gl` and `description` must outlive it.
  HeadVertexArrays(const GlFunctions& gl, const HeadDescription& description,
                   const HeadVertices& rest);
  ~HeadVertexArrays();
  HeadVertexArrays(const HeadVertexArrays&) = delete;
  HeadVertexArrays& operator=(const HeadVertexArrays&) = delete;

  /// Uploads these vertices of the head and binds its vertex array.
  void Upload(const HeadVertices& vertices);
  /// Binds the vertex array to positions and normals that are on the GPU already; those of the
  /// head begin at byte `from`.
  void Use(GLuint positions, GLuint normals, std::size_t from = 0);
  /// Returns the head's parts in drawing order, best occluders first. `error_mm`: the largest error
  /// that simplification may cause (CoarseTriangles); a level for each factor of sqrt(2) is made on
  /// first use and kept. `head` is the one described.
  const std::vector<DrawnPart>& PartsWithin(const Head& head, float error_mm);
  /// Returns the parts with all triangles.
  const std::vector<DrawnPart>& FinestParts() const { return finest_; }

 private:
  /// The buffers that the vertex array points to, and the byte at which the head begins in them.
  struct UsedBuffers {
    GLuint positions = 0, normals = 0;
    std::size_t from = 0;
    bool operator==(const UsedBuffers&) const = default;
  };

  void UploadAttributes(const HeadVertices& rest);
  /// Adds triangles to the index buffer and returns their parts.
  std::vector<DrawnPart> AddParts(const HeadTriangles& triangles, std::span<const glm::vec3> rest);

  const GlFunctions& gl_;
  const HeadDescription& description_;
  GLuint array_ = 0;
  std::array<GLuint, VertexAttribute::kCount> buffers_{};
  GLuint index_buffer_ = 0;
  UsedBuffers used_;
  std::vector<DrawnPart> finest_;                 // with all triangles
  std::map<int, std::vector<DrawnPart>> levels_;  // coarser; key k means an error of 2^(k / 2) mm
  std::vector<std::uint32_t> indices_;            // of all these parts
  std::vector<SkinDetail> skin_detail_;           // by vertex
};

}  // namespace fsm
