#pragma once

#include <optional>

#include "fsm/render/eye_material.h"
#include "fsm/render/head_textures.h"
#include "fsm/render/photo_material.h"

namespace fsm {

/// Which shader program, with which numbers and textures, draws which material; the same for all
/// heads that are drawn in a context. Destroy while its context is current.
class Materials {
 public:
  /// `gl` and `appearance` outlive it.
  Materials(const GlFunctions& gl, const Appearance& appearance);
  ~Materials();
  Materials(const Materials&) = delete;
  Materials& operator=(const Materials&) = delete;

  /// Hands camera, eyes and the like to every program. `vertices` are in the head's own frame;
  /// `head` and `textures` are that head's, until the next call.
  void BeginFrame(const View& view, const HeadBuffers& head, const HeadTextures& textures,
                  const HeadVertices& vertices, const Scene& scene);
  /// Whether nothing of a part is seen in this frame: teeth, gums and tongue behind lips that are
  /// shut.
  bool IsHidden(const DrawnPart& part) const;
  void Use(const DrawnPart& part);
  /// Whether the creased variants of shaders are used: what BeginFrame found, until it is set.
  bool creased() const { return creased_; }
  void SetCreased(bool creased) { creased_ = creased; }
  /// A plain colour, for lines and for passes whose colour is not kept.
  void UseLine(const glm::vec4& colour);

 private:
  enum Texture { kNoise, kWeave, kStrands, kPlain, kTextures };

  void Bind(GLuint texture, TextureUnit unit);
  /// 0: of one colour.
  void BindOrPlain(GLuint texture, TextureUnit unit);
  void SetSurface(const GlProgram& program, const MaterialFrame& frame) const;
  void UseSurface(const DrawnPart& part);
  void UsePbr(const PbrMaterial& pbr);
  void UseHair(float streaks, float shine);

  const GlFunctions& gl_;
  const Appearance& appearance_;
  GlProgram surface_;
  GlProgram smooth_;  // the same without relief
  GlProgram hair_;
  GlProgram line_;
  std::optional<GlProgram> pbr_;  // made for the first head that has any
  MouthMaterial mouth_;
  EyeMaterial eye_;
  PhotoMaterial photo_;
  GLuint shared_textures_[kTextures] = {};
  const HeadBuffers* head_ = nullptr;  // of the last BeginFrame
  const HeadTextures* head_textures_ = nullptr;
  bool creased_ = false;  // any skin, in the last BeginFrame
  bool pores_ = false;    // are seen
};

}  // namespace fsm
