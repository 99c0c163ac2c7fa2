#include "fsm/render/materials.h"

#include <glm/geometric.hpp>
#include <vector>

#include "embedded/creases.h"
#include "embedded/eye_vertex.h"
#include "embedded/hair_fragment.h"
#include "embedded/hair_vertex.h"
#include "embedded/line_fragment.h"
#include "embedded/pbr_fragment.h"
#include "embedded/pbr_vertex.h"
#include "embedded/surface_common.h"
#include "embedded/surface_fragment.h"
#include "embedded/surface_vertex.h"
#include "fsm/render/gpu_heads.h"
#include "fsm/render/noise_tile.h"

namespace fsm {
namespace {

constexpr bool IsOfMouth(Material material) {
  return material == Material::kTeeth || material == Material::kGum ||
         material == Material::kTongue || material == Material::kMouthInside;
}

}  // namespace

Materials::Materials(const GlFunctions& gl, const Appearance& appearance)
    : gl_(gl),
      appearance_(appearance),
      surface_(
          CompileLit(gl, appearance, "surface",
                     {embedded::surface_common(), embedded::creases(), embedded::surface_vertex()},
                     embedded::surface_fragment(), ShaderConstant("kRelief", true))),
      smooth_(
          CompileLit(gl, appearance, "smooth",
                     {embedded::surface_common(), embedded::creases(), embedded::surface_vertex()},
                     embedded::surface_fragment(), ShaderConstant("kRelief", false))),
      hair_(
          CompileLit(gl, appearance, "hair", {embedded::hair_vertex()}, embedded::hair_fragment())),
      line_(
          CompileLit(gl, appearance, "line", {embedded::eye_vertex()}, embedded::line_fragment())),
      mouth_(gl, appearance),
      eye_(gl, appearance),
      photo_(gl, appearance) {
  gl_.GenTextures(kTextures, shared_textures_);
  const Image noise = MakeNoiseTile();
  FillTexture(gl_, shared_textures_[kNoise], noise, GL_LINEAR);
  FillTexture(gl_, shared_textures_[kWeave], noise, GL_NEAREST);
  FillTexture(gl_, shared_textures_[kStrands], MakeStrandTile(), GL_NEAREST);
  FillTexture(gl_, shared_textures_[kPlain], {1, 1, {128, 128, 128, 128}}, GL_NEAREST);
}

Materials::~Materials() { gl_.DeleteTextures(kTextures, shared_textures_); }

void Materials::Bind(GLuint texture, TextureUnit unit) {
  gl_.ActiveTexture(GlUnit(unit));
  gl_.BindTexture(GL_TEXTURE_2D, texture);
}

void Materials::BindOrPlain(GLuint texture, TextureUnit unit) {
  Bind(texture != 0 ? texture : shared_textures_[kPlain], unit);
}

void Materials::BeginFrame(const FrameCamera& view, const GpuHead& head,
                           const HeadVertices& vertices, const Scene& scene) {
  head_ = &head;
  const MaterialFrame frame = FrameOf(appearance_, view, head.description, vertices, scene);
  creased_ = frame.creases != Sided<glm::vec4>{} || frame.more_creases != Sided<glm::vec2>{};
  pores_ = view.samples_per_mm >= appearance_.pores_from;
  photo_.Prepare(head.description, head.arrays.FinestParts());
  if (!head.description.surface->pbr_materials.empty() && !pbr_) {
    pbr_.emplace(
        CompileLit(gl_, appearance_, "pbr", {embedded::pbr_vertex()}, embedded::pbr_fragment()));
  }
  std::vector<const GlProgram*> programs{&surface_, &smooth_,          &hair_,
                                         &line_,    &mouth_.program(), &eye_.program()};
  for (const auto& program : photo_.programs()) {
    if (program) programs.push_back(&*program);
  }
  if (pbr_) programs.push_back(&*pbr_);
  Bind(shared_textures_[kNoise], TextureUnit::kNoise);
  Bind(shared_textures_[kStrands], TextureUnit::kStrands);
  for (const GlProgram* program : programs) {
    program->Use();
    program->Set("noise", TextureUnit::kNoise);
    program->Set("strands", TextureUnit::kStrands);
    SetLight(*program, frame);
  }
  SetSurface(surface_, frame);
  SetSurface(smooth_, frame);
  SetSurface(mouth_.program(), frame);
  hair_.Use();
  hair_.Set("rest_to_world", frame.rest_to_world);
  mouth_.Begin(frame);
  photo_.Begin(frame, mouth_);
  eye_.Begin(frame);
  if (!pbr_) return;
  pbr_->Use();
  pbr_->Set("brightness", frame.lamp_brightness);
  pbr_->Set("base_colour", TextureUnit::kBaseColour);
  pbr_->Set("normal_roughness_metal", TextureUnit::kNormalMap);
  pbr_->Set("emission_openness", TextureUnit::kEmissiveMap);
}

void Materials::SetSurface(const GlProgram& program, const MaterialFrame& frame) const {
  program.Use();
  program.Set("tint", TextureUnit::kTint);
  program.Set("relief", TextureUnit::kRelief);
  program.Set("head_up", glm::normalize(frame.rest_to_world[1]));
  SetCreases(program, frame);
}

bool Materials::IsHidden(const DrawnPart& drawn) const {
  // The lining of the mouth also lines the nostrils.
  return mouth_.lips_shut() && IsOfMouth(drawn.part.material) &&
         drawn.part.material != Material::kMouthInside;
}

void Materials::Use(const DrawnPart& drawn) {
  const HeadSurface::Part& part = drawn.part;
  if (part.pbr >= 0) {
    return UsePbr(head_->description.surface->pbr_materials[static_cast<std::size_t>(part.pbr)]);
  }
  if (PhotoMaterial::Draws(part.material, head_->description)) {
    photo_.Use(drawn, head_->description, creased_);
    BindOrPlain(head_->textures.base_colour(), TextureUnit::kBaseColour);
    return BindOrPlain(head_->textures.skin_relief(), TextureUnit::kRelief);
  }
  switch (part.material) {
    case Material::kSclera:
    case Material::kIris:
    case Material::kPupil:
      BindOrPlain(head_->textures.base_colour(), TextureUnit::kBaseColour);
      return eye_.program().Use();
    case Material::kHair:
      return UseHair(1.0f, 1.0f);
    case Material::kLash:
      return UseHair(0.0f, 0.0f);
    default:
      return UseSurface(drawn);
  }
}

void Materials::UseSurface(const DrawnPart& drawn) {
  const Material material = drawn.part.material;
  // Matte parts are as dull as the lining of the mouth, which the table describes.
  const Appearance::Surface& surface =
      appearance_.surface(material == Material::kMatte ? Material::kMouthInside : material);
  const bool inside = mouth_.has_opening() && IsOfMouth(material);
  const bool threads = surface.detail_per_mm > 0;
  const bool relief = threads ? surface.bump > 0 && pores_
                              : pores_ || (creased_ && drawn.detail != SkinDetail::kPlain);
  const GlProgram& program = inside ? mouth_.program() : relief ? surface_ : smooth_;
  program.Use();
  program.Set("wrap", surface.wrap);
  program.Set("lobes", 2.0f * surface.lobes);  // the texture's value 0.5 stands for 1
  if (inside) {
    program.Set("lining", material == Material::kMouthInside);
  } else {
    program.Set("key_through", surface.key_through);
    program.Set("sheen", surface.sheen);
  }
  program.Set("saturation", surface.saturation);
  program.Set("bump", surface.bump);
  program.Set("detail_per_mm", surface.detail_per_mm);
  program.Set("chroma", head_->description.surface->portrait.saturation);
  BindOrPlain(threads ? 0 : head_->textures.tint(), TextureUnit::kTint);
  BindOrPlain(threads ? shared_textures_[kWeave] : head_->textures.skin_relief(),
              TextureUnit::kRelief);
}

void Materials::UsePbr(const PbrMaterial& pbr) {
  pbr_->Use();
  pbr_->Set("cut_out", pbr.cut_out);
  pbr_->Set("toon", pbr.kind == PbrMaterial::Kind::kToon);
  pbr_->Set("metallic", pbr.metallic);
  pbr_->Set("roughness", pbr.roughness);
  pbr_->Set("shade_to", pbr.shade_to);
  pbr_->Set("light_from", pbr.light_from);
  pbr_->Set("emissive", pbr.emissive);
  pbr_->Set("shade_colour", pbr.shade_colour);
  BindOrPlain(head_->textures.base_colour(), TextureUnit::kBaseColour);
  Bind(head_->textures.normal_roughness_metal(), TextureUnit::kNormalMap);
  Bind(head_->textures.emission_openness(), TextureUnit::kEmissiveMap);
}

void Materials::UseHair(float streaks, float shine) {
  hair_.Use();
  hair_.Set("streaks", streaks);
  hair_.Set("shine", shine);
}

void Materials::UseLine(const glm::vec4& colour) {
  line_.Use();
  line_.Set("line_colour", colour);
}

}  // namespace fsm
