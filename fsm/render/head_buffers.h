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
#include "fsm/render/eye_frame.h"
#include "fsm/render/gl_functions.h"
#include "fsm/render/mouth_frame.h"
#include "fsm/render/shadow_frame.h"
#include "fsm/render/skin_texture.h"
#include "fsm/rig/head.h"

namespace fsm {

/// One head on the GL side: what never changes is uploaded at the beginning, vertices every frame.
/// Destroy while its context is current.
class HeadBuffers {
 public:
  HeadBuffers(const GlFunctions& gl, const Head& head);
  ~HeadBuffers();
  HeadBuffers(const HeadBuffers&) = delete;
  HeadBuffers& operator=(const HeadBuffers&) = delete;

  /// Binds the head's vertex array with these vertices, which are the head's, in it.
  void Upload(const HeadVertices& vertices);
  /// The same with buffers of places and of normals that are on the card already.
  void Use(GLuint positions, GLuint normals);
  /// Those at which eyes(), shadows() and mouth() look.
  std::vector<std::uint32_t> MeasuredVertices() const;
  /// The head's parts in the order to draw them, what hides most first. `error_mm`: by how much
  /// at most it may be coarser than it is (CoarseTriangles); each step of the root of 2 is made
  /// when it is first asked for, and kept. `head` is that of the constructor.
  const std::vector<DrawnPart>& Parts(const Head& head, float error_mm);
  /// All of its triangles.
  const std::vector<DrawnPart>& parts() const { return levels_.at(kFinest); }
  const EyeFinder& eyes() const { return eyes_; }
  const ShadowFinder& shadows() const { return shadows_; }
  const MouthFinder& mouth() const { return mouth_; }
  /// True until skin() has been asked for since the head came: it is being painted meanwhile.
  bool painting() const { return painting_.valid(); }
  /// The detail of this head's skin; nothing if it does not say where its features are. Waits until
  /// it is painted.
  const SkinTexture* skin();
  /// Sizes and colours of the eyes, which both share.
  const EyeGeometry& eye_geometry() const { return eye_geometry_; }
  /// WornPicture::image; null if the skin is painted.
  const Image* photo() const { return photo_.get(); }
  /// How fine the photo lies on the head at rest, as seen from the front; 0 without one.
  float photo_texels_per_mm() const { return photo_texels_per_mm_; }
  /// DrawOrder::Blends.
  bool blends() const { return blends_; }
  /// WornPicture::normal_map, emissive_map and HeadTopology::pbr_materials.
  const Image* normal_map() const { return normal_map_.get(); }
  const Image* emissive_map() const { return emissive_map_.get(); }
  const std::vector<PbrMaterial>& pbr_materials() const { return pbr_materials_; }
  /// Where the photo shows eyes: Portrait::eyes.
  const std::optional<Sided<EyePicture>>& eye_pictures() const { return eye_pictures_; }
  /// The eyes as they are at rest. REQUIRES: eyes().found().
  const Sided<EyeFrame>& resting_eyes() const { return resting_eyes_; }
  /// Height of the chin's lowest point at rest, millimetres; of a head without landmarks far below.
  float chin_y() const { return chin_y_; }
  /// Portrait::light.
  glm::vec4 photo_light() const { return photo_light_; }
  /// Portrait::saturation.
  float saturation() const { return saturation_; }

 private:
  static constexpr float kNoChin = -1e4F;
  static constexpr int kFinest = -100;

  void UploadTopology(const Head& head);
  void AddLevel(int level, const HeadTopology& topology, const HeadTriangles& triangles,
                std::span<const glm::vec3> rest);
  void CopyTopology(const HeadTopology& topology);

  const GlFunctions& gl_;
  GLuint array_ = 0;
  // Position, normal, rest position, colour and occlusion; of skin its unrolled place, creases of
  // the right and of the left side; of hair its place among hairs, direction and density,
  // place across its lock; place in the photo with the photo's part in the colour and how much is
  // lid, the lid's ShutLid::grain_at and slide, opacity, rest normal; indices.
  static constexpr GLuint kAttributes = 11;
  GLuint buffers_[kAttributes + 1] = {};
  std::array<GLuint, 2> used_{};  // for the first two of them
  std::size_t vertex_count_ = 0;
  std::map<int, std::vector<DrawnPart>> levels_;  // by the error, as a power of the root of 2
  std::vector<std::uint32_t> indices_;            // of all levels
  CreaseWeights creases_;
  std::vector<Worn> worn_;
  EyeFinder eyes_;
  ShadowFinder shadows_;
  MouthFinder mouth_;
  EyeGeometry eye_geometry_;
  std::optional<SkinTexture> skin_;
  std::future<SkinTexture> painting_;  // on a thread of its own, which the future joins
  std::shared_ptr<const Image> photo_, normal_map_, emissive_map_;
  std::vector<PbrMaterial> pbr_materials_;
  std::optional<Sided<EyePicture>> eye_pictures_;
  Sided<EyeFrame> resting_eyes_;
  float photo_texels_per_mm_ = 0;
  float saturation_ = 1;
  glm::vec4 photo_light_{0, 0, 0, 1};
  float chin_y_ = kNoChin;
  bool blends_ = false;
};

}  // namespace fsm
