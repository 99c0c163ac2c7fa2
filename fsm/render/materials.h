#pragma once

#include <optional>

#include "fsm/render/eye_material.h"
#include "fsm/render/photo_material.h"

namespace fsm {

struct GpuHead;

/// Selects shader program, uniforms and textures for each material; shared by all heads of a
/// context. Destroy while its context is current.
class Materials {
 public:
  /// `gl` and `appearance` must outlive it.
  Materials(const GlFunctions& gl, const Appearance& appearance);
  ~Materials();
  Materials(const Materials&) = delete;
  Materials& operator=(const Materials&) = delete;

  /// Sets the uniforms of every program for a frame. `vertices` are in the head's own frame; `head`
  /// stays in use until the next call.
  void BeginFrame(const FrameCamera& view, const GpuHead& head, const HeadVertices& vertices,
                  const Scene& scene);
  /// Tells whether nothing of a part is visible in this frame: teeth, gums and tongue behind closed
  /// lips.
  bool IsHidden(const DrawnPart& drawn) const;
  void Use(const DrawnPart& drawn);
  /// Whether the creased shader variants are used: BeginFrame decides, SetCreased overrides.
  bool creased() const { return creased_; }
  void SetCreased(bool creased) { creased_ = creased; }
  /// Selects a plain colour, for lines and for passes whose colour is discarded.
  void UseLine(const glm::vec4& colour);

 private:
  enum Texture { kNoise, kWeave, kStrands, kPlain, kTextures };

  void Bind(GLuint texture, TextureUnit unit);
  /// Binds a plain texture in place of name 0.
  void BindOrPlain(GLuint texture, TextureUnit unit);
  void SetSurface(const GlProgram& program, const MaterialFrame& frame) const;
  void UseSurface(const DrawnPart& drawn);
  void UsePbr(const PbrMaterial& pbr);
  void UseHair(float streaks, float shine);

  const GlFunctions& gl_;
  const Appearance& appearance_;
  GlProgram surface_;
  GlProgram smooth_;  // like surface_, without relief
  GlProgram hair_;
  GlProgram line_;
  std::optional<GlProgram> pbr_;  // compiled for the first head that needs it
  MouthMaterial mouth_;
  EyeMaterial eye_;
  PhotoMaterial photo_;
  GLuint shared_textures_[kTextures] = {};
  const GpuHead* head_ = nullptr;  // that of the last BeginFrame
  bool creased_ = false;           // whether any skin creases in this frame
  bool pores_ = false;             // whether pores are visible
};

}  // namespace fsm
