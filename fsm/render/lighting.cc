#include "fsm/render/lighting.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "embedded/lighting.h"
#include "embedded/transform.h"

namespace fsm {
namespace {

Appearance::Lamp LampOf(const Appearance& appearance, const char* name,
                        const DirectionalLight& wanted) {
  Appearance::Lamp lamp = appearance.lamp(name);
  if (wanted.direction) lamp.direction = *wanted.direction;
  // White is as bright as the lamp is by itself.
  if (wanted.tint) {
    lamp.colour = *wanted.tint * (lamp.colour.r + lamp.colour.g + lamp.colour.b) / 3.0F;
  }
  lamp.colour *= wanted.strength;
  return lamp;
}

/// The lamps of the table, changed as a scene wants them.
Lamps LampsOf(const Appearance& appearance, const Scene& scene) {
  const std::array lamps = {LampOf(appearance, "key", scene.key),
                            LampOf(appearance, "fill", scene.fill),
                            LampOf(appearance, "rim", scene.rim)};
  Lamps out;
  for (std::size_t i = 0; i < lamps.size(); ++i) {
    out.directions[i] = glm::normalize(lamps[i].direction);
    out.colours[i] = lamps[i].colour;
  }
  return out;
}

}  // namespace

MaterialFrame FrameOf(const Appearance& appearance, const View& view, const HeadBuffers& head,
                      const HeadVertices& vertices, const Scene& scene) {
  const Lamps lamps = LampsOf(appearance, scene);
  const float room = appearance("photo_room_light");
  const float usual = appearance.lamp("key").colour.g + appearance.lamp("fill").colour.g + room;
  const auto shadows = head.shadows().Measure(vertices);
  MaterialFrame frame{
      .view = view,
      .head = head,
      .vertices = vertices,
      .lamps = lamps,
      .shadows = shadows,
      .rest_to_world = glm::mat3(view.figure_to_world) * shadows.turn,
      .photo_brightness = std::sqrt((lamps.colours[0].g + lamps.colours[1].g + room) / usual),
      .creases = {},
      .nose_creases = vertices.creases[static_cast<std::size_t>(Crease::kNose)]};
  for (const Side side : kSides) {
    for (int k = 0; k < 4; ++k) {
      frame.creases[side][k] = vertices.creases[static_cast<std::size_t>(k)][side];
    }
  }
  return frame;
}

GlProgram CompileLit(const GlFunctions& gl, const Appearance& appearance, const char* name,
                     std::initializer_list<std::string_view> vertex, std::string_view fragment,
                     std::string_view more) {
  const std::string common = "#version 330 core\n" + appearance.constants() + std::string(more) +
                             std::string(embedded::lighting());
  std::string vertex_text = common, fragment_text = common;
  vertex_text += embedded::transform();
  for (const std::string_view text : vertex) vertex_text += text;
  fragment_text += fragment;
  return {gl, name, vertex_text, fragment_text};
}

void SetLight(const GlProgram& program, const MaterialFrame& frame) {
  const glm::mat4 world_to_figure = glm::inverse(frame.view.figure_to_world);
  const std::array occluders = {frame.shadows.skull * world_to_figure,
                                frame.shadows.nose * world_to_figure};
  std::array<glm::vec3, 2> keys;
  for (std::size_t i = 0; i < 2; ++i) {
    keys[i] = glm::normalize(glm::mat3(occluders[i]) * frame.lamps.directions[0]);
  }
  program.Set("figure_to_world", frame.view.figure_to_world);
  program.Set("world_to_clip", frame.view.world_to_clip);
  program.Set("eye", frame.view.eye);
  program.Set("lamp_directions", frame.lamps.directions);
  program.Set("lamp_colours", frame.lamps.colours);
  program.Set("occluders", occluders);
  program.Set("occluder_lights", keys);
}

void SetCreases(const GlProgram& program, const MaterialFrame& frame) {
  program.Set("crease_depths", frame.creases.InOrder());
  program.Set("nose_creases", frame.nose_creases.InOrder());
}

std::string ShaderConstant(const char* name, bool value) {
  return std::string("const bool ") + name + (value ? " = true;\n" : " = false;\n");
}

}  // namespace fsm
