#include "fsm/render/lighting.h"

#include <fmt/format.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "embedded/lighting.h"
#include "embedded/transform.h"
#include "fsm/render/vertex_attributes.h"

namespace fsm {
namespace {

/// Returns the lamps of the table with the changes that a scene asks for.
Lamps LampsOf(const Appearance& appearance, const Scene& scene) {
  Lamps out;
  const auto set = [&out](std::size_t i, const auto& row, const DirectionalLight& wanted) {
    out.directions[i] = glm::normalize(wanted.direction.value_or(row.direction));
    // A white tint keeps the lamp's own brightness.
    const float mean = (row.light.r + row.light.g + row.light.b) / 3.0f;
    out.colours[i] = wanted.strength * (wanted.tint ? *wanted.tint * mean : row.light);
  };
  set(0, appearance.lamp.key, scene.key);
  set(1, appearance.lamp.fill, scene.fill);
  set(2, appearance.lamp.rim, scene.rim);
  return out;
}

}  // namespace

MaterialFrame FrameOf(const Appearance& appearance, const FrameCamera& view,
                      const HeadDescription& head, const HeadVertices& vertices,
                      const Scene& scene) {
  const Lamps lamps = LampsOf(appearance, scene);
  const float room = appearance.photo_room_light;
  const float usual = appearance.lamp.key.light.g + appearance.lamp.fill.light.g + room;
  const auto shadows = head.shadows.Measure(vertices);
  MaterialFrame frame{
      .view = view,
      .head = head,
      .vertices = vertices,
      .lamps = lamps,
      .shadows = shadows,
      .rest_to_world = glm::mat3(view.figure_to_world) * shadows.rotation,
      .lamp_brightness = std::sqrt((lamps.colours[0].g + lamps.colours[1].g + room) / usual),
      .creases = {},
      .more_creases = {}};
  for (const Side side : kSides) {
    for (int k = 0; k < 4; ++k) {
      frame.creases[side][k] = vertices.creases[static_cast<std::size_t>(k)][side];
    }
    frame.more_creases[side] = {Of(vertices.creases, Crease::kNose)[side],
                                Of(vertices.creases, Crease::kForeheadSides)[side]};
  }
  return frame;
}

GlProgram CompileLit(const GlFunctions& gl, const Appearance& appearance, const char* name,
                     std::initializer_list<std::string_view> vertex, std::string_view fragment,
                     std::string_view more) {
  const std::string common = "#version 330 core\n" + appearance.constants() + std::string(more) +
                             std::string(embedded::lighting());
  std::string vertex_text = common, fragment_text = common;
  vertex_text += ShaderNumbers<VertexAttribute::Location>() + std::string(embedded::transform());
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
  program.Set("more_crease_depths", frame.more_creases.InOrder());
}

std::string ShaderConstant(const char* name, bool value) {
  return fmt::format("const bool {} = {};\n", name, value);
}
std::string ShaderConstant(const char* name, int value) {
  return fmt::format("const int {} = {};\n", name, value);
}

}  // namespace fsm
