#pragma once

#include <array>
#include <glm/mat3x3.hpp>
#include <glm/vec4.hpp>
#include <memory>
#include <vector>

#include "fsm/render/camera.h"
#include "fsm/render/gl_objects.h"
#include "fsm/render/head_buffers.h"
#include "fsm/render/renderer.h"
#include "fsm/rig/head.h"

namespace fsm {

/// The shader programs and which of them, with which numbers, draws which material.
/// Destroy while its context is current.
class Materials {
 public:
  explicit Materials(const GlFunctions& gl);
  ~Materials();
  Materials(const Materials&) = delete;
  Materials& operator=(const Materials&) = delete;

  /// Hands camera, eyes and the like to every program. `vertices` are in the head's own frame.
  void BeginFrame(const View& view, const HeadBuffers& head, const HeadVertices& vertices,
                  const Scene& scene, float alpha);
  void Use(const HeadTopology::Part& part);
  /// Gives the head of the last BeginFrame its skin, which is plain until then, in the detail that
  /// the picture can show. Waits until it is painted.
  void WearSkin(HeadBuffers& head, float samples_per_mm);
  /// A plain colour, for lines and for passes whose colour is not kept.
  void UseLine(const glm::vec4& color);

 private:
  enum Texture {
    kNoise,
    kWeave,
    kStrands,
    kPlain,
    kSkinTint,
    kSkinRelief,
    kPhoto,
    kRelief,
    kLights,
    kTextures
  };

  void Fill(Texture texture, int width, int height, const std::uint8_t* rgba);
  void Bind(Texture texture, GLenum unit);
  void SetEyes(const View& view, const HeadBuffers& head, const std::array<EyeFrame, 2>& eyes);
  void SetEyePictures(const HeadBuffers& head, const std::array<EyeFrame, 2>& eyes,
                      const glm::mat3& rest_to_world);
  void SetMouth(const View& view, const HeadBuffers& head, const HeadVertices& vertices,
                glm::vec3 key_direction);
  void Use(Material material);
  void UsePhoto(Material material);
  void UseMaterial(const PbrMaterial& finish);
  void UseHair(float streaks, float shine);

  const GlFunctions& gl_;
  GlProgram surface_;
  GlProgram mouth_;
  GlProgram eye_;
  GlProgram hair_;
  GlProgram line_;
  GlProgram photo_;
  std::unique_ptr<GlProgram> finish_;  // made for the first head that has any
  std::vector<PbrMaterial> finishes_;
  GLuint textures_[kTextures] = {};
  int generation_ = 0;  // of the head whose skin is in the textures
  bool has_skin_ = false;
  bool has_photo_ = false, blends_ = false;
  bool has_mouth_ = false;  // of which is known how light comes in
  float chroma_ = 1;        // of the picture, 0 beside a grey photo
  int skin_level_ = 0;
  GLint skin_filter_ = 0;
};

}  // namespace fsm
