#include "fsm/render/materials.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <string>
#include <utility>
#include <vector>

#include "embedded/eye_fragment.h"
#include "embedded/eye_vertex.h"
#include "embedded/finish_fragment.h"
#include "embedded/finish_vertex.h"
#include "embedded/hair_fragment.h"
#include "embedded/hair_vertex.h"
#include "embedded/lighting.h"
#include "embedded/line_fragment.h"
#include "embedded/mouth_vertex.h"
#include "embedded/photo_fragment.h"
#include "embedded/photo_vertex.h"
#include "embedded/surface_fragment.h"
#include "embedded/surface_vertex.h"
#include "embedded/transform.h"
#include "fsm/render/noise_tile.h"

namespace fsm {
namespace {

/// A lamp of the studio as a scene wants it.
Appearance::Lamp LampOf(const Appearance& appearance, const char* name,
                        const DirectionalLight& wanted) {
  Appearance::Lamp lamp = appearance.lamp(name);
  if (wanted.direction) lamp.direction = *wanted.direction;
  // White is as bright as the lamp is by itself.
  if (wanted.tint) {
    lamp.color = *wanted.tint * (lamp.color.r + lamp.color.g + lamp.color.b) / 3.0F;
  }
  lamp.color *= wanted.strength;
  return lamp;
}

constexpr bool IsOfMouth(Material material) {
  return material == Material::kTeeth || material == Material::kGum ||
         material == Material::kTongue || material == Material::kMouthInside;
}

}  // namespace

Materials::Materials(const GlFunctions& gl, const Appearance& appearance)
    : gl_(gl),
      appearance_(appearance),
      surface_(Compile("surface", embedded::surface_vertex(), embedded::surface_fragment())),
      mouth_(Compile("mouth", embedded::mouth_vertex(), embedded::surface_fragment())),
      eye_(Compile("eye", embedded::eye_vertex(), embedded::eye_fragment())),
      hair_(Compile("hair", embedded::hair_vertex(), embedded::hair_fragment())),
      line_(Compile("line", embedded::eye_vertex(), embedded::line_fragment())) {
  gl_.GenTextures(kTextures, textures_);
  const auto noise = MakeNoiseTile();
  const auto strands = MakeStrandTile();
  const std::uint8_t plain[] = {128, 128, 128, 128};
  FillTexture(gl_, textures_[kNoise], kNoiseCells, kNoiseCells, noise.data(), GL_LINEAR);
  FillTexture(gl_, textures_[kWeave], kNoiseCells, kNoiseCells, noise.data(), GL_NEAREST);
  FillTexture(gl_, textures_[kStrands], kStrandsAcross, kStrandsAlong, strands.data(), GL_NEAREST);
  FillTexture(gl_, textures_[kPlain], 1, 1, plain, GL_NEAREST);
}

GlProgram Materials::Compile(const char* name, std::string_view vertex, std::string_view fragment,
                             std::string_view more) const {
  const std::string common = "#version 330 core\n" + appearance_.constants() + std::string(more) +
                             std::string(embedded::lighting());
  std::string vertex_text = common, fragment_text = common;
  vertex_text += embedded::transform();
  vertex_text += vertex;
  fragment_text += fragment;
  return {gl_, name, vertex_text, fragment_text};
}

Materials::~Materials() { gl_.DeleteTextures(kTextures, textures_); }

void Materials::Bind(GLuint texture, GLenum unit) {
  gl_.ActiveTexture(unit);
  gl_.BindTexture(GL_TEXTURE_2D, texture);
}

void Materials::BindOrPlain(GLuint texture, GLenum unit) {
  Bind(texture != 0 ? texture : textures_[kPlain], unit);
}

void Materials::BeginFrame(const View& view, const HeadBuffers& head, const HeadTextures& textures,
                           const HeadVertices& vertices, const Scene& scene, float alpha) {
  head_ = &head;
  worn_ = &textures;
  const std::array lamps = {LampOf(appearance_, "key", scene.key),
                            LampOf(appearance_, "fill", scene.fill),
                            LampOf(appearance_, "rim", scene.rim)};
  glm::vec3 directions[3];
  glm::vec3 colors[3];
  for (std::size_t i = 0; i < 3; ++i) {
    directions[i] = glm::normalize(lamps[i].direction);
    colors[i] = lamps[i].color;
  }
  const glm::mat4 world_to_figure = glm::inverse(view.figure_to_world);
  const auto shadows = head.shadows().Measure(vertices);
  const glm::mat4 occluders[] = {shadows.skull * world_to_figure, shadows.nose * world_to_figure};
  glm::vec3 lights[2];
  for (int i = 0; i < 2; ++i) lights[i] = glm::normalize(glm::mat3(occluders[i]) * directions[0]);

  Bind(textures_[kNoise], GL_TEXTURE0);
  Bind(textures_[kStrands], GL_TEXTURE3);
  for (const GlProgram* program : ProgramsOf(head)) {
    gl_.UseProgram(program->id());
    gl_.UniformMatrix4fv(program->Uniform("figure_to_world"), 1, GL_FALSE,
                         glm::value_ptr(view.figure_to_world));
    gl_.UniformMatrix4fv(program->Uniform("world_to_clip"), 1, GL_FALSE,
                         glm::value_ptr(view.world_to_clip));
    gl_.Uniform3fv(program->Uniform("eye"), 1, glm::value_ptr(view.eye));
    gl_.Uniform1f(program->Uniform("alpha"), alpha);
    gl_.Uniform1i(program->Uniform("noise"), 0);
    gl_.Uniform1i(program->Uniform("strands"), 3);
    gl_.Uniform3fv(program->Uniform("lamp_directions"), 3, glm::value_ptr(directions[0]));
    gl_.Uniform3fv(program->Uniform("lamp_colors"), 3, glm::value_ptr(colors[0]));
    gl_.UniformMatrix4fv(program->Uniform("occluders"), 2, GL_FALSE, glm::value_ptr(occluders[0]));
    gl_.Uniform3fv(program->Uniform("occluder_lights"), 2, glm::value_ptr(lights[0]));
  }
  const glm::vec3 head_up = glm::normalize(glm::mat3(view.figure_to_world) * shadows.turn[1]);
  for (const GlProgram* program : {&mouth_, &surface_}) {
    gl_.UseProgram(program->id());
    gl_.Uniform1i(program->Uniform("tint"), 1);
    gl_.Uniform1i(program->Uniform("relief"), 2);
    gl_.Uniform3fv(program->Uniform("head_up"), 1, glm::value_ptr(head_up));
  }
  glm::vec4 depths[2];
  for (int side = 0; side < 2; ++side) {
    for (int k = 0; k < 4; ++k) {
      depths[side][k] =
          vertices.wrinkles[static_cast<std::size_t>(k)][static_cast<std::size_t>(side)];
    }
  }
  gl_.Uniform4fv(surface_.Uniform("crease_depths"), 2, glm::value_ptr(depths[0]));
  // The photo's light stands for the lamps as they are by default.
  const float room = appearance_.Number("photo_room_light");
  const float usual = appearance_.lamp("key").color.g + appearance_.lamp("fill").color.g + room;
  const float brightness = std::sqrt((colors[0].g + colors[1].g + room) / usual);
  if (finish_) {
    gl_.UseProgram(finish_->id());
    gl_.Uniform1f(finish_->Uniform("brightness"), brightness);
    gl_.Uniform1i(finish_->Uniform("photo"), 1);
    gl_.Uniform1i(finish_->Uniform("relief"), 4);
    gl_.Uniform1i(finish_->Uniform("lights"), 5);
  }
  gl_.UseProgram(hair_.id());
  const glm::mat3 rest_to_world = glm::mat3(view.figure_to_world) * shadows.turn;
  gl_.UniformMatrix3fv(hair_.Uniform("rest_to_world"), 1, GL_FALSE, glm::value_ptr(rest_to_world));
  SetPhoto(head, vertices, depths, rest_to_world, brightness);
  SetMouth(view, head, vertices, directions[0]);
  if (!head.eyes().found()) return;
  const auto eyes = head.eyes().Measure(vertices);
  SetEyes(view, head, eyes);
  // The white of a grey photo is grey, and so is the flesh beside it.
  const glm::vec3 white = head.eye_place().white_colour;
  const bool grey = std::abs(white.r - white.g) + std::abs(white.g - white.b) < 0.02F * white.g;
  const bool shown = head.photo() && head.eye_pictures();
  const glm::vec3 worn(head.photo() ? brightness : 0, grey ? 0 : 1, shown ? kIrisSpan : 0);
  gl_.Uniform3fv(eye_.Uniform("worn"), 1, glm::value_ptr(worn));
  gl_.Uniform1i(eye_.Uniform("photo"), 1);
  if (shown) SetEyePictures(head, eyes, rest_to_world);
}

std::vector<const GlProgram*> Materials::ProgramsOf(const HeadBuffers& head) {
  std::vector<const GlProgram*> programs{&surface_, &mouth_, &eye_, &hair_, &line_};
  for (const DrawnPart& part : head.parts()) {
    auto& photo = photo_[part.detailed];
    if (photo || !WearsPhoto(part.part.material)) continue;
    const char* detailed =
        part.detailed ? "const bool kDetailed = true;\n" : "const bool kDetailed = false;\n";
    photo.reset(new GlProgram(
        Compile("photo", embedded::photo_vertex(), embedded::photo_fragment(), detailed)));
  }
  if (!head.finishes().empty() && !finish_) {
    finish_.reset(
        new GlProgram(Compile("finish", embedded::finish_vertex(), embedded::finish_fragment())));
  }
  for (const auto* program : {&photo_[0], &photo_[1], &finish_}) {
    if (*program) programs.push_back(program->get());
  }
  return programs;
}

void Materials::SetPhoto(const HeadBuffers& head, const HeadVertices& vertices,
                         const glm::vec4* crease_depths, const glm::mat3& rest_to_world,
                         float brightness) {
  for (const auto& photo : photo_) {
    if (!photo) continue;
    gl_.UseProgram(photo->id());
    gl_.Uniform4fv(photo->Uniform("crease_depths"), 2, glm::value_ptr(crease_depths[0]));
    gl_.Uniform1fv(photo->Uniform("lids_shut"), 2, vertices.lids_shut.data());
    gl_.Uniform1i(photo->Uniform("photo"), 1);
    gl_.Uniform1f(photo->Uniform("blends"), head.blends() ? 1.0F : 0.0F);
    gl_.Uniform1i(photo->Uniform("relief"), 2);
    gl_.Uniform1f(photo->Uniform("brightness"), brightness);
    gl_.UniformMatrix3fv(photo->Uniform("rest_to_world"), 1, GL_FALSE,
                         glm::value_ptr(rest_to_world));
    gl_.Uniform4fv(photo->Uniform("photo_light"), 1, glm::value_ptr(head.photo_light()));
  }
}

bool Materials::WearsPhoto(Material material) const {
  return material == Material::kPhoto || material == Material::kShutLash ||
         (head_->photo() && (material == Material::kSkin || material == Material::kLip));
}

void Materials::Use(Material material, bool detailed) {
  if (WearsPhoto(material)) return UsePhoto(material, detailed);
  switch (material) {
    case Material::kSclera:
    case Material::kIris:
    case Material::kPupil:
      BindOrPlain(worn_->photo(), GL_TEXTURE1);
      return gl_.UseProgram(eye_.id());
    case Material::kHair:
      return UseHair(1.0F, 1.0F);
    case Material::kLash:
      return UseHair(0.0F, 0.0F);
    default:
      break;
  }
  const Appearance::Surface& surface = appearance_.surface(material);
  const bool inside = has_mouth_ && IsOfMouth(material);
  const GlProgram& program = inside ? mouth_ : surface_;
  gl_.UseProgram(program.id());
  gl_.Uniform3fv(program.Uniform("wrap"), 1, glm::value_ptr(surface.wrap));
  const glm::vec3 lobes = 2.0F * surface.lobes;  // of a texture in which one half stands for 1
  gl_.Uniform3fv(program.Uniform("lobes"), 1, glm::value_ptr(lobes));
  if (inside) {
    gl_.Uniform1f(program.Uniform("lining"), material == Material::kMouthInside ? 1.0F : 0.0F);
  } else {
    gl_.Uniform1f(program.Uniform("key_through"), surface.key_through);
    gl_.Uniform1f(program.Uniform("sheen"), surface.sheen);
  }
  gl_.Uniform1f(program.Uniform("saturation"), surface.saturation);
  gl_.Uniform1f(program.Uniform("bump"), surface.bump);
  gl_.Uniform1f(program.Uniform("planar"), surface.planar);
  gl_.Uniform1f(program.Uniform("chroma"), head_->saturation());
  const bool planar = surface.planar > 0;
  BindOrPlain(planar ? 0 : worn_->tint(), GL_TEXTURE1);
  BindOrPlain(planar ? textures_[kWeave] : worn_->skin_relief(), GL_TEXTURE2);
}

void Materials::Use(const DrawnPart& drawn) {
  const auto& part = drawn.part;
  if (part.finish < 0) return Use(part.material, drawn.detailed);
  UseMaterial(head_->finishes()[static_cast<std::size_t>(part.finish)]);
}

void Materials::UseMaterial(const PbrMaterial& finish) {
  gl_.UseProgram(finish_->id());
  gl_.Uniform1f(finish_->Uniform("ragged"), finish.cut_out ? 1.0F : 0.0F);
  gl_.Uniform1f(finish_->Uniform("toon"), finish.kind == PbrMaterial::Kind::kToon ? 1.0F : 0.0F);
  gl_.Uniform1f(finish_->Uniform("metallic"), finish.metallic);
  gl_.Uniform1f(finish_->Uniform("roughness"), finish.roughness);
  gl_.Uniform1f(finish_->Uniform("shade_to"), finish.shade_to);
  gl_.Uniform1f(finish_->Uniform("light_from"), finish.light_from);
  gl_.Uniform3fv(finish_->Uniform("glow"), 1, glm::value_ptr(finish.glow));
  gl_.Uniform3fv(finish_->Uniform("shade"), 1, glm::value_ptr(finish.shade));
  BindOrPlain(worn_->photo(), GL_TEXTURE1);
  Bind(worn_->relief(), GL_TEXTURE4);
  Bind(worn_->lights(), GL_TEXTURE5);
}

void Materials::UsePhoto(Material material, bool detailed) {
  const GlProgram& photo = *photo_[detailed];
  const bool ragged = material == Material::kPhoto;
  gl_.UseProgram(photo.id());
  gl_.Uniform1f(photo.Uniform("lashes"), material == Material::kShutLash ? 1.0F : 0.0F);
  gl_.Uniform1f(photo.Uniform("ragged"), ragged ? 1.0F : 0.0F);
  // Where the sheet goes on from the skin the skin is seen, however coarse the sheet.
  constexpr float kYields = 5;
  gl_.Uniform1f(photo.Uniform("yields"), ragged && head_->blends() ? kYields : 0.0F);
  BindOrPlain(worn_->photo(), GL_TEXTURE1);
  BindOrPlain(worn_->skin_relief(), GL_TEXTURE2);
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
