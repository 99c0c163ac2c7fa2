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

/// One head on the GL side: what never changes is uploaded when it is made, vertices every frame.
/// Destroy while its context is current.
class HeadBuffers {
 public:
  /// `gl` and `appearance` outlive it.
  HeadBuffers(const GlFunctions& gl, const Head& head, const Appearance& appearance);
  ~HeadBuffers();
  HeadBuffers(const HeadBuffers&) = delete;
  HeadBuffers& operator=(const HeadBuffers&) = delete;

  /// Binds the head's vertex array with these vertices, which are the head's, in it.
  void Upload(const HeadVertices& vertices);
  /// The same with buffers of positions and of normals that are on the card already, of which the
  /// head's begin `from` bytes in.
  void Use(GLuint positions, GLuint normals, std::size_t from = 0);
  /// The vertices at which eyes(), shadows() and mouth() look.
  std::vector<std::uint32_t> MeasuredVertices() const;
  /// The head's parts in the order to draw them, what hides most first. `error_mm`: by how much
  /// at most it may be coarser than it is (CoarseTriangles); each step of the root of 2 is made
  /// when it is first asked for, and kept. `head` is that of the constructor.
  const std::vector<DrawnPart>& PartsWithin(const Head& head, float error_mm);
  /// All of its triangles.
  const std::vector<DrawnPart>& FinestParts() const { return levels_.at(kFinest); }
  const EyeFinder& eyes() const { return eyes_; }
  const ShadowFinder& shadows() const { return shadows_; }
  const MouthFinder& mouth() const { return mouth_; }
  /// True until skin() has been asked for since the head came: it is being painted meanwhile.
  bool painting() const { return painting_.valid(); }
  /// The detail of this head's skin; nothing if it does not say where its features are. Waits until
  /// it is painted.
  const SkinTexture* skin();
  const HeadTopology& topology() const { return *topology_; }
  /// TextureMaps::image; null if the skin is painted.
  const Image* photo() const { return topology_->textures.image.get(); }
  /// How fine the photo lies on the head at rest, as seen from the front; 0 without one.
  float photo_texels_per_mm() const { return photo_texels_per_mm_; }
  /// The eyes as they are at rest. REQUIRES: eyes().found().
  const Sided<EyePose>& resting_eyes() const { return resting_eyes_; }
  /// Height of the chin's lowest point at rest, millimetres; of a head without landmarks far below.
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
  std::array<std::size_t, 3> used_{};             // positions, normals and where they begin
  std::map<int, std::vector<DrawnPart>> levels_;  // by the error, as a power of the root of 2
  std::vector<std::uint32_t> indices_;            // of all levels
  CreaseWeights creases_;
  std::vector<SkinDetail> skin_detail_;  // of every vertex
  EyeFinder eyes_;
  ShadowFinder shadows_;
  MouthFinder mouth_;
  std::optional<SkinTexture> skin_;
  std::future<SkinTexture> painting_;  // on a thread of its own, which the future joins
  Sided<EyePose> resting_eyes_;
  float photo_texels_per_mm_ = 0;
  float chin_y_ = kNoChin;
};

}  // namespace fsm
