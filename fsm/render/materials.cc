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
#include "embedded/hair_fragment.h"
#include "embedded/hair_vertex.h"
#include "embedded/lighting.h"
#include "embedded/line_fragment.h"
#include "embedded/mouth_vertex.h"
#include "embedded/pbr_fragment.h"
#include "embedded/pbr_vertex.h"
#include "embedded/photo_fragment.h"
#include "embedded/photo_vertex.h"
#include "embedded/surface_fragment.h"
#include "embedded/surface_vertex.h"
#include "embedded/transform.h"
#include "fsm/render/noise_tile.h"

namespace fsm {
namespace {

/// A lamp of the table as a scene wants it.
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

Lamps LampsOf(const Appearance& appearance, const Scene& scene) {
  const std::array lamps = {LampOf(appearance, "key", scene.key),
                            LampOf(appearance, "fill", scene.fill),
                            LampOf(appearance, "rim", scene.rim)};
  Lamps out;
  for (std::size_t i = 0; i < lamps.size(); ++i) {
    out.directions[i] = glm::normalize(lamps[i].direction);
    out.colors[i] = lamps[i].color;
  }
  return out;
}

SideDepths DepthsOf(const HeadVertices& vertices) {
  SideDepths depths;
  for (const Side side : kSides) {
    for (int k = 0; k < 4; ++k) {
      depths[side][k] = vertices.creases[static_cast<std::size_t>(k)][side];
    }
  }
  return depths;
}

/// Of a shader.
std::string Constant(const char* name, bool value) {
  return std::string("const bool ") + name + (value ? " = true;\n" : " = false;\n");
}

constexpr bool IsOfMouth(Material material) {
  return material == Material::kTeeth || material == Material::kGum ||
         material == Material::kTongue || material == Material::kMouthInside;
}

}  // namespace

Materials::Materials(const GlFunctions& gl, const Appearance& appearance)
    : gl_(gl),
      appearance_(appearance),
      surface_(Compile("surface", embedded::surface_vertex(), embedded::surface_fragment(),
                       Constant("kRelief", true))),
      smooth_(Compile("smooth", embedded::surface_vertex(), embedded::surface_fragment(),
                      Constant("kRelief", false))),
      mouth_(Compile("mouth", embedded::mouth_vertex(), embedded::surface_fragment(),
                     Constant("kRelief", true))),
      eye_(Compile("eye", embedded::eye_vertex(), embedded::eye_fragment())),
      hair_(Compile("hair", embedded::hair_vertex(), embedded::hair_fragment())),
      line_(Compile("line", embedded::eye_vertex(), embedded::line_fragment())) {
  gl_.GenTextures(kTextures, shared_textures_);
  const auto noise = MakeNoiseTile();
  const auto strands = MakeStrandTile();
  const std::uint8_t plain[] = {128, 128, 128, 128};
  FillTexture(gl_, shared_textures_[kNoise], kNoiseCells, kNoiseCells, noise.data(), GL_LINEAR);
  FillTexture(gl_, shared_textures_[kWeave], kNoiseCells, kNoiseCells, noise.data(), GL_NEAREST);
  FillTexture(gl_, shared_textures_[kStrands], kStrandsAcross, kStrandsAlong, strands.data(),
              GL_NEAREST);
  FillTexture(gl_, shared_textures_[kPlain], 1, 1, plain, GL_NEAREST);
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

Materials::~Materials() { gl_.DeleteTextures(kTextures, shared_textures_); }

void Materials::Bind(GLuint texture, GLenum unit) {
  gl_.ActiveTexture(unit);
  gl_.BindTexture(GL_TEXTURE_2D, texture);
}

void Materials::BindOrPlain(GLuint texture, GLenum unit) {
  Bind(texture != 0 ? texture : shared_textures_[kPlain], unit);
}

void Materials::BeginFrame(const View& view, const HeadBuffers& head, const HeadTextures& textures,
                           const HeadVertices& vertices, const Scene& scene) {
  head_ = &head;
  head_textures_ = &textures;
  const Lamps lamps = LampsOf(appearance_, scene);
  const auto shadows = head.shadows().Measure(vertices);
  const glm::mat3 rest_to_world = glm::mat3(view.figure_to_world) * shadows.turn;
  Bind(shared_textures_[kNoise], GL_TEXTURE0);
  Bind(shared_textures_[kStrands], GL_TEXTURE3);
  for (const GlProgram* program : ProgramsOf(head)) {
    gl_.UseProgram(program->id());
    gl_.Uniform1i(program->Uniform("noise"), 0);
    gl_.Uniform1i(program->Uniform("strands"), 3);
    SetView(*program, view);
    SetLight(*program, lamps, shadows, glm::inverse(view.figure_to_world));
  }
  const SideDepths depths = DepthsOf(vertices);
  creases_ = depths != SideDepths{};
  pores_ = view.samples_per_mm >= appearance_.Number("pores_from");
  const float brightness = PhotoBrightness(lamps);
  SetSurface(glm::normalize(rest_to_world[1]), depths);
  SetPbr(brightness);
  gl_.UseProgram(hair_.id());
  gl_.UniformMatrix3fv(hair_.Uniform("rest_to_world"), 1, GL_FALSE, glm::value_ptr(rest_to_world));
  SetPhoto(head, vertices, depths, rest_to_world, brightness);
  SetMouth(view, head, vertices, lamps.directions[0]);
  if (head.eyes().found()) SetEyes(view, head, vertices, rest_to_world, brightness);
}

void Materials::SetView(const GlProgram& program, const View& view) {
  gl_.UniformMatrix4fv(program.Uniform("figure_to_world"), 1, GL_FALSE,
                       glm::value_ptr(view.figure_to_world));
  gl_.UniformMatrix4fv(program.Uniform("world_to_clip"), 1, GL_FALSE,
                       glm::value_ptr(view.world_to_clip));
  gl_.Uniform3fv(program.Uniform("eye"), 1, glm::value_ptr(view.eye));
}

void Materials::SetLight(const GlProgram& program, const Lamps& lamps,
                         const ShadowFinder::Occluders& shadows, const glm::mat4& world_to_figure) {
  const glm::mat4 occluders[] = {shadows.skull * world_to_figure, shadows.nose * world_to_figure};
  glm::vec3 keys[2];
  for (int i = 0; i < 2; ++i) {
    keys[i] = glm::normalize(glm::mat3(occluders[i]) * lamps.directions[0]);
  }
  gl_.Uniform3fv(program.Uniform("lamp_directions"), 3, glm::value_ptr(lamps.directions[0]));
  gl_.Uniform3fv(program.Uniform("lamp_colors"), 3, glm::value_ptr(lamps.colors[0]));
  gl_.UniformMatrix4fv(program.Uniform("occluders"), 2, GL_FALSE, glm::value_ptr(occluders[0]));
  gl_.Uniform3fv(program.Uniform("occluder_lights"), 2, glm::value_ptr(keys[0]));
}

void Materials::SetSurface(glm::vec3 head_up, const SideDepths& depths) {
  for (const GlProgram* program : {&mouth_, &surface_, &smooth_}) {
    gl_.UseProgram(program->id());
    gl_.Uniform1i(program->Uniform("tint"), 1);
    gl_.Uniform1i(program->Uniform("relief"), 2);
    gl_.Uniform3fv(program->Uniform("head_up"), 1, glm::value_ptr(head_up));
    gl_.Uniform4fv(program->Uniform("crease_depths"), 2, glm::value_ptr(depths.InOrder()[0]));
  }
}

void Materials::SetPbr(float brightness) {
  if (!pbr_) return;
  gl_.UseProgram(pbr_->id());
  gl_.Uniform1f(pbr_->Uniform("brightness"), brightness);
  gl_.Uniform1i(pbr_->Uniform("photo"), 1);
  gl_.Uniform1i(pbr_->Uniform("normal_map"), 4);
  gl_.Uniform1i(pbr_->Uniform("emissive_map"), 5);
}

float Materials::PhotoBrightness(const Lamps& lamps) const {
  const float room = appearance_.Number("photo_room_light");
  const float usual = appearance_.lamp("key").color.g + appearance_.lamp("fill").color.g + room;
  return std::sqrt((lamps.colors[0].g + lamps.colors[1].g + room) / usual);
}

std::vector<const GlProgram*> Materials::ProgramsOf(const HeadBuffers& head) {
  std::vector<const GlProgram*> programs{&surface_, &smooth_, &mouth_, &eye_, &hair_, &line_};
  for (const DrawnPart& part : head.parts()) {
    auto& photo = photo_[static_cast<std::size_t>(part.worn)];
    if (photo || !WearsPhoto(part.part.material)) continue;
    photo.reset(new GlProgram(Compile("photo", embedded::photo_vertex(), embedded::photo_fragment(),
                                      Constant("kCreased", part.worn != Worn::kPlain) +
                                          Constant("kDetailed", part.worn == Worn::kDetailed))));
  }
  if (!head.pbr_materials().empty() && !pbr_) {
    pbr_.reset(new GlProgram(Compile("pbr", embedded::pbr_vertex(), embedded::pbr_fragment())));
  }
  for (const auto* program : {&photo_[0], &photo_[1], &photo_[2], &pbr_}) {
    if (*program) programs.push_back(program->get());
  }
  return programs;
}

void Materials::SetPhoto(const HeadBuffers& head, const HeadVertices& vertices,
                         const SideDepths& crease_depths, const glm::mat3& rest_to_world,
                         float brightness) {
  for (const auto& photo : photo_) {
    if (!photo) continue;
    gl_.UseProgram(photo->id());
    gl_.Uniform4fv(photo->Uniform("crease_depths"), 2, glm::value_ptr(crease_depths.InOrder()[0]));
    gl_.Uniform1fv(photo->Uniform("lids_shut"), 2, vertices.lids_shut.InOrder().data());
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

void Materials::Use(Material material, Worn worn) {
  if (WearsPhoto(material)) return UsePhoto(material, worn);
  switch (material) {
    case Material::kSclera:
    case Material::kIris:
    case Material::kPupil:
      BindOrPlain(head_textures_->photo(), GL_TEXTURE1);
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
  const GlProgram& program = inside ? mouth_ : HasRelief(surface, worn) ? surface_ : smooth_;
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
  BindOrPlain(planar ? 0 : head_textures_->tint(), GL_TEXTURE1);
  BindOrPlain(planar ? shared_textures_[kWeave] : head_textures_->skin_relief(), GL_TEXTURE2);
}

bool Materials::IsHidden(const DrawnPart& part) const {
  // What lines the mouth lines nostrils, too.
  return lips_shut_ && IsOfMouth(part.part.material) &&
         part.part.material != Material::kMouthInside;
}

void Materials::Use(const DrawnPart& drawn) {
  const auto& part = drawn.part;
  if (part.pbr < 0) return Use(part.material, drawn.worn);
  UsePbr(head_->pbr_materials()[static_cast<std::size_t>(part.pbr)]);
}

bool Materials::HasRelief(const Appearance::Surface& surface, Worn worn) const {
  const bool threads = surface.planar > 0;
  return threads ? surface.bump > 0 : pores_ || (creases_ && worn != Worn::kPlain);
}

void Materials::UsePbr(const PbrMaterial& pbr) {
  gl_.UseProgram(pbr_->id());
  gl_.Uniform1f(pbr_->Uniform("ragged"), pbr.cut_out ? 1.0F : 0.0F);
  gl_.Uniform1f(pbr_->Uniform("toon"), pbr.kind == PbrMaterial::Kind::kToon ? 1.0F : 0.0F);
  gl_.Uniform1f(pbr_->Uniform("metallic"), pbr.metallic);
  gl_.Uniform1f(pbr_->Uniform("roughness"), pbr.roughness);
  gl_.Uniform1f(pbr_->Uniform("shade_to"), pbr.shade_to);
  gl_.Uniform1f(pbr_->Uniform("light_from"), pbr.light_from);
  gl_.Uniform3fv(pbr_->Uniform("glow"), 1, glm::value_ptr(pbr.glow));
  gl_.Uniform3fv(pbr_->Uniform("shade"), 1, glm::value_ptr(pbr.shade));
  BindOrPlain(head_textures_->photo(), GL_TEXTURE1);
  Bind(head_textures_->normal_map(), GL_TEXTURE4);
  Bind(head_textures_->emissive_map(), GL_TEXTURE5);
}

void Materials::UsePhoto(Material material, Worn worn) {
  // Where nothing creases now, skin is the photo and nothing else, too.
  const bool smooth = worn == Worn::kCreased && !creases_ && photo_[0];
  const GlProgram& photo = *photo_[smooth ? 0 : static_cast<std::size_t>(worn)];
  const bool ragged = material == Material::kPhoto;
  gl_.UseProgram(photo.id());
  gl_.Uniform1f(photo.Uniform("lashes"), material == Material::kShutLash ? 1.0F : 0.0F);
  gl_.Uniform1f(photo.Uniform("ragged"), ragged ? 1.0F : 0.0F);
  // Where the sheet goes on from the skin the skin is seen, however coarse the sheet.
  constexpr float kYields = 5;
  gl_.Uniform1f(photo.Uniform("yields"), ragged && head_->blends() ? kYields : 0.0F);
  BindOrPlain(head_textures_->photo(), GL_TEXTURE1);
  BindOrPlain(head_textures_->skin_relief(), GL_TEXTURE2);
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
