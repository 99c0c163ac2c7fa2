#pragma once

#include <array>
#include <cstdint>
#include <future>
#include <glm/vec3.hpp>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "fsm/render/draw_order.h"
#include "fsm/render/eye_finder.h"
#include "fsm/render/gl_functions.h"
#include "fsm/render/mouth_finder.h"
#include "fsm/render/shadow_finder.h"
#include "fsm/render/skin_creases.h"
#include "fsm/render/skin_texture.h"
#include "fsm/render/vertex_attributes.h"
#include "fsm/rig/head.h"

namespace fsm {

/// One head on the GL side: constant data is uploaded on construction, vertices every frame.
/// Destroy while its context is current.
class HeadBuffers {
 public:
  /// `gl` and `appearance` must outlive it.
  HeadBuffers(const GlFunctions& gl, const Head& head, const Appearance& appearance);
  ~HeadBuffers();
  HeadBuffers(const HeadBuffers&) = delete;
  HeadBuffers& operator=(const HeadBuffers&) = delete;

  /// Uploads these vertices of the head and binds its vertex array.
  void Upload(const HeadVertices& vertices);
  /// Binds the vertex array to positions and normals that are on the card already; those of the
  /// head begin at byte `from`.
  void Use(GLuint positions, GLuint normals, std::size_t from = 0);
  /// Returns the vertices that eyes(), shadows() and mouth() read.
  std::vector<std::uint32_t> MeasuredVertices() const;
  /// Returns the head's parts in drawing order, best occluders first. `error_mm`: the largest error
  /// that simplification may cause (CoarseTriangles); a level for each factor of sqrt(2) is made on
  /// first use and kept. `head` is that of the constructor.
  const std::vector<DrawnPart>& PartsWithin(const Head& head, float error_mm);
  /// Returns the parts with all triangles.
  const std::vector<DrawnPart>& FinestParts() const { return levels_.at(kFinest); }
  const EyeFinder& eyes() const { return eyes_; }
  const ShadowFinder& shadows() const { return shadows_; }
  const MouthFinder& mouth() const { return mouth_; }
  /// True while the skin is being painted: from construction until skin() is first called.
  bool painting() const { return painting_.valid(); }
  /// Returns the detail of this head's skin; null if the head lacks landmarks of its features.
  /// Blocks until it is painted.
  const SkinTexture* skin();
  const HeadTopology& topology() const { return *topology_; }
  /// TextureMaps::image; null if the skin is painted.
  const Image* photo() const { return topology_->textures.image.get(); }
  /// The photo's resolution on the head at rest, as seen from the front; 0 without a photo.
  float photo_texels_per_mm() const { return photo_texels_per_mm_; }
  /// The eyes at rest. REQUIRES: eyes().found().
  const Sided<EyePose>& resting_eyes() const { return resting_eyes_; }
  /// Height of the chin's lowest point at rest, millimetres; kNoChin for a head without landmarks.
  float chin_y() const { return chin_y_; }

 private:
  static constexpr float kNoChin = -1e4F;
  static constexpr int kFinest = -100;

  void UploadAttributes(const HeadVertices& rest);
  void AddLevel(int level, const HeadTriangles& triangles, std::span<const glm::vec3> rest);

  const GlFunctions& gl_;
  const std::shared_ptr<const HeadTopology> topology_;
  GLuint array_ = 0;
  std::array<GLuint, VertexAttribute::kCount> buffers_{};
  GLuint index_buffer_ = 0;
  std::array<std::size_t, 3> used_{};             // positions, normals and their offset
  std::map<int, std::vector<DrawnPart>> levels_;  // by error: key k means 2^(k / 2) mm
  std::vector<std::uint32_t> indices_;            // of all levels
  CreaseWeights creases_;
  std::vector<SkinDetail> skin_detail_;  // by vertex
  EyeFinder eyes_;
  ShadowFinder shadows_;
  MouthFinder mouth_;
  std::optional<SkinTexture> skin_;
  std::future<SkinTexture> painting_;  // runs on its own thread, which the future joins
  Sided<EyePose> resting_eyes_;
  float photo_texels_per_mm_ = 0;
  float chin_y_ = kNoChin;
};

}  // namespace fsm
