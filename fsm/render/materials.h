#pragma once

#include <array>
#include <glm/mat3x3.hpp>
#include <glm/vec4.hpp>
#include <memory>
#include <vector>

#include "fsm/render/appearance.h"
#include "fsm/render/camera.h"
#include "fsm/render/gl_objects.h"
#include "fsm/render/head_buffers.h"
#include "fsm/render/head_textures.h"
#include "fsm/render/scene.h"
#include "fsm/rig/head.h"

namespace fsm {

/// Key, fill and rim: unit vectors towards them, in the world, and their light, linear.
struct Lamps {
  std::array<glm::vec3, 3> directions, colors;
};

/// How deep creases are, 0..1: of forehead, glabella, crow's feet, nasolabial.
using SideDepths = Sided<glm::vec4>;

/// The shader programs and which of them, with which numbers, draws which material; the same for
/// all heads that are drawn in a context.
/// Destroy while its context is current.
class Materials {
 public:
  /// `appearance` outlives it.
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
  /// Whether skin creases; as BeginFrame found, or as is set until the next.
  bool creased() const { return creases_; }
  void SetCreased(bool creased) { creases_ = creased; }
  /// A plain colour, for lines and for passes whose colour is not kept.
  void UseLine(const glm::vec4& color);

 private:
  enum Texture { kNoise, kWeave, kStrands, kPlain, kTextures };

  /// A program of the parts that all have and its own; `more` stands before it in both.
  GlProgram Compile(const char* name, std::string_view vertex, std::string_view fragment,
                    std::string_view more = "") const;
  void Bind(GLuint texture, GLenum unit);
  /// 0: of one colour.
  void BindOrPlain(GLuint texture, GLenum unit);
  /// The programs that the parts of the head need, made if they are not there yet.
  std::vector<const GlProgram*> ProgramsOf(const HeadBuffers& head);
  // The following hand uniforms to programs; the first two to the one in use.
  void SetView(const GlProgram& program, const View& view);
  void SetLight(const GlProgram& program, const Lamps& lamps,
                const ShadowFinder::Occluders& shadows, const glm::mat4& world_to_figure);
  void SetSurface(glm::vec3 head_up, const SideDepths& depths);
  void SetPbr(float brightness);
  void SetPhoto(const HeadBuffers& head, const HeadVertices& vertices,
                const SideDepths& crease_depths, const glm::mat3& rest_to_world, float brightness);
  void SetEyes(const View& view, const HeadBuffers& head, const HeadVertices& vertices,
               const glm::mat3& rest_to_world, float brightness);
  void SetEyeballs(const View& view, const Sided<EyeFrame>& eyes, const EyeGeometry& place);
  void SetEyePictures(const HeadBuffers& head, const Sided<EyeFrame>& eyes,
                      const glm::mat3& rest_to_world);
  void SetMouth(const View& view, const HeadBuffers& head, const HeadVertices& vertices,
                glm::vec3 key_direction);
  /// How much brighter than by default the lamps are: a photo's own light stands for the default.
  float PhotoBrightness(const Lamps& lamps) const;
  void Use(Material material, Worn worn);
  bool HasRelief(const Appearance::Surface& surface, Worn worn) const;
  bool WearsPhoto(Material material) const;
  void UsePhoto(Material material, Worn worn);
  void UsePbr(const PbrMaterial& pbr);
  void UseHair(float streaks, float shine);

  const GlFunctions& gl_;
  const Appearance& appearance_;
  GlProgram surface_;
  GlProgram smooth_;  // the same without relief
  GlProgram mouth_;
  GlProgram eye_;
  GlProgram hair_;
  GlProgram line_;
  // Made for the first head that has any.
  std::array<std::unique_ptr<GlProgram>, 3> photo_;  // by Worn
  std::unique_ptr<GlProgram> pbr_;
  GLuint shared_textures_[kTextures] = {};
  const HeadBuffers* head_ = nullptr;  // of the last BeginFrame
  const HeadTextures* head_textures_ = nullptr;
  bool creases_ = false;    // any skin, in the last BeginFrame
  bool pores_ = false;      // are seen
  bool lips_shut_ = false;  // all along
  bool has_mouth_ = false;  // of which is known how light comes in
};

}  // namespace fsm
