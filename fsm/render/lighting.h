#pragma once

#include <array>
#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <initializer_list>
#include <string>
#include <string_view>

#include "fsm/render/appearance.h"
#include "fsm/render/camera.h"
#include "fsm/render/gl_objects.h"
#include "fsm/render/head_description.h"
#include "fsm/render/scene.h"
#include "fsm/rig/head.h"

namespace fsm {

/// Key, fill and rim: unit vectors towards the lamps in the world's frame, and linear colours.
struct Lamps {
  std::array<glm::vec3, 3> directions, colours;
};

/// What the materials of a head know about the frame being drawn. Borrowed for the frame.
struct MaterialFrame {
  const FrameCamera& view;
  const HeadDescription& head;
  const HeadVertices& vertices;  ///< in the head's own frame
  Lamps lamps;
  ShadowFinder::Occluders shadows;
  glm::mat3 rest_to_world;  ///< rotation of the head, with the figure's scale
  /// Brightness of the lamps relative to the default, which stands for the photo's own light.
  float lamp_brightness;
  Sided<glm::vec4> creases;       ///< depth of each of the first four Creases, 0..1
  Sided<glm::vec2> more_creases;  ///< those of the nose and of the sides of the forehead
};
MaterialFrame FrameOf(const Appearance& appearance, const FrameCamera& view,
                      const HeadDescription& head, const HeadVertices& vertices,
                      const Scene& scene);

/// Compiles a program from its own sources and the code that all programs share to transform and
/// light a head's vertices. `more` precedes both.
GlProgram CompileLit(const GlFunctions& gl, const Appearance& appearance, const char* name,
                     std::initializer_list<std::string_view> vertex, std::string_view fragment,
                     std::string_view more = "");
/// Sets the uniforms for camera, lamps and shadows.
void SetLight(const GlProgram& program, const MaterialFrame& frame);
/// Sets the uniforms of shaders/creases.glsl.
void SetCreases(const GlProgram& program, const MaterialFrame& frame);
/// Returns a line such as "const bool NAME = true;" for CompileLit.
std::string ShaderConstant(const char* name, bool value);
std::string ShaderConstant(const char* name, int value);

}  // namespace fsm
