#pragma once

#include <array>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <initializer_list>
#include <string>
#include <string_view>

#include "fsm/render/appearance.h"
#include "fsm/render/camera.h"
#include "fsm/render/gl_objects.h"
#include "fsm/render/head_buffers.h"
#include "fsm/render/scene.h"
#include "fsm/rig/head.h"

namespace fsm {

/// Key, fill and rim: unit vectors towards them, in the world, and their light, linear.
struct Lamps {
  std::array<glm::vec3, 3> directions, colours;
};

/// What the materials of a head know of the frame they are drawn in. Borrowed for the frame.
struct MaterialFrame {
  const View& view;
  const HeadBuffers& head;
  const HeadVertices& vertices;  ///< in the head's own frame
  Lamps lamps;
  ShadowFinder::Occluders shadows;
  glm::mat3 rest_to_world;  ///< how the head is turned, with the figure's scale
  /// How much brighter than by default the lamps are: a photo's own light stands for the default.
  float photo_brightness;
  Sided<glm::vec4> creases;  ///< how deep each Crease but the nose's is, 0..1
  Sided<float> nose_creases;
};
MaterialFrame FrameOf(const Appearance& appearance, const View& view, const HeadBuffers& head,
                      const HeadVertices& vertices, const Scene& scene);

/// Makes a program of its own texts and of what all programs that place a head's vertices and
/// light them have in common. `more` stands before both.
GlProgram CompileLit(const GlFunctions& gl, const Appearance& appearance, const char* name,
                     std::initializer_list<std::string_view> vertex, std::string_view fragment,
                     std::string_view more = "");
/// Hands camera, lamps and shadows to such a program.
void SetLight(const GlProgram& program, const MaterialFrame& frame);
/// For programs with shaders/creases.glsl.
void SetCreases(const GlProgram& program, const MaterialFrame& frame);
/// "const bool NAME = true;" for CompileLit.
std::string ShaderConstant(const char* name, bool value);

}  // namespace fsm
