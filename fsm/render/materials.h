#pragma once

#include <glm/vec4.hpp>

#include "fsm/head/head.h"
#include "fsm/render/camera.h"
#include "fsm/render/gl_objects.h"
#include "fsm/render/head_buffers.h"

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
                  float alpha);
  void Use(Material material);
  /// A plain colour, for lines and for passes whose colour is not kept.
  void UseLine(const glm::vec4& color);

 private:
  void SetEyes(const View& view, const HeadBuffers& head, const HeadVertices& vertices);
  void UseEye(float layer);
  void UseHair(float streaks, float shine);

  const GlFunctions& gl_;
  GlProgram surface_;
  GlProgram eye_;
  GlProgram hair_;
  GlProgram line_;
  GLuint noise_ = 0;
};

}  // namespace fsm
