#include "fsm/render/materials.h"

#include <array>
#include <glm/geometric.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <initializer_list>
#include <string>

#include "embedded/eye_fragment.h"
#include "embedded/eye_vertex.h"
#include "embedded/hair_fragment.h"
#include "embedded/hair_vertex.h"
#include "embedded/lighting.h"
#include "embedded/line_fragment.h"
#include "embedded/surface_fragment.h"
#include "embedded/surface_vertex.h"
#include "embedded/transform.h"
#include "fsm/render/noise_volume.h"

namespace fsm {
namespace {

/// From the face towards the key light: above the viewer's left shoulder.
constexpr glm::vec3 kKeyDirection{-1.0F, 0.88F, 0.95F};

/// How a surface takes light; the names are those of the uniforms in surface_*.glsl.
struct Surface {
  Material material;
  glm::vec3 wrap;   // how far light goes round under the surface
  glm::vec3 lobes;  // broad, middle, tight highlight
  float key_through;
  float sheen;
  float saturation;
  float bump;
  float grain;
};

// Skin scatters red farthest and is dull; wet things mirror in a small spot; enamel scatters
// evenly; cloth only scatters.
constexpr Surface kSurfaces[] = {
    // material               wrap                   lobes            through sheen satur. bump
    // grain
    {Material::kSkin, {0.45F, 0.22F, 0.12F}, {1.5F, 1.8F, 0.0F}, 0.35F, 1.0F, 1.12F, 0.15F, 0.10F},
    {Material::kLip, {0.40F, 0.20F, 0.12F}, {1.2F, 1.0F, 4.5F}, 0.35F, 1.0F, 1.10F, 0.20F, 0.10F},
    {Material::kTeeth, {0.30F, 0.26F, 0.22F}, {0.0F, 3.0F, 3.0F}, 0.0F, 0.2F, 1.0F, 0.03F, 0.03F},
    {Material::kGum, {0.40F, 0.20F, 0.15F}, {0.0F, 3.5F, 2.0F}, 0.0F, 0.2F, 1.0F, 0.10F, 0.10F},
    {Material::kTongue, {0.40F, 0.20F, 0.15F}, {1.0F, 2.0F, 0.0F}, 0.0F, 0.2F, 1.0F, 0.30F, 0.20F},
    {Material::kMouthInside,
     {0.40F, 0.20F, 0.15F},
     {0.5F, 0.5F, 0.0F},
     0.0F,
     0.0F,
     1.0F,
     0.05F,
     0.05F},
    {Material::kCloth, {0.25F, 0.25F, 0.25F}, {0.1F, 0.0F, 0.0F}, 0.0F, 0.6F, 1.0F, 0.25F, 0.25F},
};

/// A shader is made of texts, shared ones first.
std::string Join(std::initializer_list<std::string_view> texts) {
  std::string whole;
  for (const auto text : texts) whole += text;
  return whole;
}

std::string Vertex(std::string_view own) {
  return Join({embedded::lighting(), embedded::transform(), own});
}

std::string Fragment(std::string_view own) { return Join({embedded::lighting(), own}); }

}  // namespace

Materials::Materials(const GlFunctions& gl)
    : gl_(gl),
      surface_(gl, "surface", Vertex(embedded::surface_vertex()),
               Fragment(embedded::surface_fragment())),
      eye_(gl, "eye", Vertex(embedded::eye_vertex()), Fragment(embedded::eye_fragment())),
      hair_(gl, "hair", Vertex(embedded::hair_vertex()), Fragment(embedded::hair_fragment())),
      line_(gl, "line", Vertex(embedded::eye_vertex()), embedded::line_fragment()) {
  gl_.GenTextures(1, &noise_);
  gl_.BindTexture(GL_TEXTURE_3D, noise_);
  for (const int axis : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T, GL_TEXTURE_WRAP_R}) {
    gl_.TexParameteri(GL_TEXTURE_3D, static_cast<GLenum>(axis), GL_REPEAT);
  }
  // From the nearest of the halved volumes only: mixing two costs as much again and shows nothing.
  gl_.TexParameteri(GL_TEXTURE_3D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_NEAREST);
  gl_.TexParameteri(GL_TEXTURE_3D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  const auto volume = MakeNoiseVolume();
  gl_.PixelStorei(GL_UNPACK_ALIGNMENT, 1);
  gl_.TexImage3D(GL_TEXTURE_3D, 0, GL_RGBA8, kNoiseCells, kNoiseCells, kNoiseCells, 0, GL_RGBA,
                 GL_UNSIGNED_BYTE, volume.data());
  gl_.GenerateMipmap(GL_TEXTURE_3D);
}

Materials::~Materials() { gl_.DeleteTextures(1, &noise_); }

void Materials::BeginFrame(const View& view, const HeadBuffers& head, const HeadVertices& vertices,
                           float alpha) {
  const glm::vec3 key_direction = glm::normalize(kKeyDirection);
  const glm::mat4 world_to_figure = glm::inverse(view.figure_to_world);
  const auto shadows = head.shadows().Measure(vertices);
  const glm::mat4 occluders[] = {shadows.skull * world_to_figure, shadows.nose * world_to_figure};
  glm::vec3 lights[2];
  for (int i = 0; i < 2; ++i) lights[i] = glm::normalize(glm::mat3(occluders[i]) * key_direction);

  gl_.ActiveTexture(GL_TEXTURE0);
  gl_.BindTexture(GL_TEXTURE_3D, noise_);
  for (const GlProgram* program : {&surface_, &eye_, &hair_, &line_}) {
    gl_.UseProgram(program->id());
    gl_.UniformMatrix4fv(program->Uniform("figure_to_world"), 1, GL_FALSE,
                         glm::value_ptr(view.figure_to_world));
    gl_.UniformMatrix4fv(program->Uniform("world_to_clip"), 1, GL_FALSE,
                         glm::value_ptr(view.world_to_clip));
    gl_.Uniform3fv(program->Uniform("eye"), 1, glm::value_ptr(view.eye));
    gl_.Uniform1f(program->Uniform("alpha"), alpha);
    gl_.Uniform1i(program->Uniform("noise"), 0);
    gl_.Uniform3fv(program->Uniform("key_direction"), 1, glm::value_ptr(key_direction));
    gl_.UniformMatrix4fv(program->Uniform("occluders"), 2, GL_FALSE, glm::value_ptr(occluders[0]));
    gl_.Uniform3fv(program->Uniform("occluder_lights"), 2, glm::value_ptr(lights[0]));
  }
  gl_.UseProgram(hair_.id());
  gl_.Uniform3fv(hair_.Uniform("crown"), 1, glm::value_ptr(head.crown()));
  const glm::mat3 rest_to_world = glm::mat3(view.figure_to_world) * shadows.turn;
  gl_.UniformMatrix3fv(hair_.Uniform("rest_to_world"), 1, GL_FALSE, glm::value_ptr(rest_to_world));
  if (head.eyes().found()) SetEyes(view, head, vertices);
}

void Materials::SetEyes(const View& view, const HeadBuffers& head, const HeadVertices& vertices) {
  const auto eyes = head.eyes().Measure(vertices);
  const glm::mat3 turn(view.figure_to_world);
  const float scale = glm::length(turn[0]);
  glm::vec4 balls[2];
  glm::vec3 gazes[2];
  glm::vec4 lids[2];
  for (int i = 0; i < 2; ++i) {
    const auto& eye = eyes[static_cast<std::size_t>(i)];
    const auto place = [&view](const glm::vec3& p) {
      return glm::vec3(view.figure_to_world * glm::vec4(p, 1.0F));
    };
    balls[i] = glm::vec4(place(eye.centre), eye.radius * scale);
    gazes[i] = turn * eye.gaze / scale;
    const glm::vec3 front = eye.centre + eye.gaze * eye.radius;
    lids[i].x = place({front.x, eye.upper_lid_y, front.z}).y;
    lids[i].y = place({front.x, eye.lower_lid_y, front.z}).y;
  }
  gl_.UseProgram(eye_.id());
  gl_.Uniform4fv(eye_.Uniform("ball"), 2, glm::value_ptr(balls[0]));
  gl_.Uniform3fv(eye_.Uniform("gaze"), 2, glm::value_ptr(gazes[0]));
  gl_.Uniform4fv(eye_.Uniform("lids"), 2, glm::value_ptr(lids[0]));
  gl_.Uniform1f(eye_.Uniform("iris_radius"), eyes[0].iris_radius * scale);
  gl_.Uniform1f(eye_.Uniform("figure_scale"), scale);
}

void Materials::Use(Material material) {
  switch (material) {
    case Material::kSclera:
      return UseEye(0.0F);
    case Material::kIris:
      return UseEye(1.0F);
    case Material::kPupil:
      return UseEye(2.0F);
    case Material::kHair:
      return UseHair(1.0F, 1.0F);
    case Material::kBrow:
      return UseHair(0.6F, 0.25F);
    case Material::kLash:
      return UseHair(0.0F, 0.0F);
    default:
      break;
  }
  for (const auto& surface : kSurfaces) {
    if (surface.material != material) continue;
    gl_.UseProgram(surface_.id());
    gl_.Uniform3fv(surface_.Uniform("wrap"), 1, glm::value_ptr(surface.wrap));
    gl_.Uniform3fv(surface_.Uniform("lobes"), 1, glm::value_ptr(surface.lobes));
    gl_.Uniform1f(surface_.Uniform("key_through"), surface.key_through);
    gl_.Uniform1f(surface_.Uniform("sheen"), surface.sheen);
    gl_.Uniform1f(surface_.Uniform("saturation"), surface.saturation);
    gl_.Uniform1f(surface_.Uniform("bump"), surface.bump);
    gl_.Uniform1f(surface_.Uniform("grain"), surface.grain);
  }
}

void Materials::UseEye(float layer) {
  gl_.UseProgram(eye_.id());
  gl_.Uniform1f(eye_.Uniform("layer"), layer);
}

void Materials::UseHair(float streaks, float shine) {
  gl_.UseProgram(hair_.id());
  gl_.Uniform1f(hair_.Uniform("streaks"), streaks);
  gl_.Uniform1f(hair_.Uniform("shine"), shine);
}

void Materials::UseLine(const glm::vec4& color) {
  gl_.UseProgram(line_.id());
  gl_.Uniform4fv(line_.Uniform("line_color"), 1, glm::value_ptr(color));
}

}  // namespace fsm
