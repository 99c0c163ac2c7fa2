#include "fsm/render/photo_material.h"

#include <glm/common.hpp>

#include "embedded/creases.h"
#include "embedded/photo_fragment.h"
#include "embedded/photo_vertex.h"

namespace fsm {

bool PhotoMaterial::Draws(Material material, const HeadDescription& head) {
  return material == Material::kTextured || material == Material::kShutLash ||
         (head.base_colour() && (material == Material::kSkin || material == Material::kLip));
}

void PhotoMaterial::Prepare(const HeadDescription& head, std::span<const DrawnPart> parts) {
  for (const DrawnPart& drawn : parts) {
    auto& program = programs_[static_cast<std::size_t>(drawn.detail)];
    if (program || !Draws(drawn.part.material, head)) continue;
    const std::string constants =
        ShaderConstant("kCreased", drawn.detail != SkinDetail::kPlain) +
        ShaderConstant("kDetailed", drawn.detail == SkinDetail::kDetailed);
    program.emplace(CompileLit(gl_, appearance_, "photo",
                               {embedded::creases(), embedded::photo_vertex()},
                               embedded::photo_fragment(), constants));
  }
}

void PhotoMaterial::Begin(const MaterialFrame& frame, const MouthMaterial& mouth) const {
  for (const auto& program : programs_) {
    if (!program) continue;
    program->Use();
    SetCreases(*program, frame);
    program->Set("lids_shut", frame.vertices.lids_shut.InOrder());
    program->Set("base_colour", TextureUnit::kBaseColour);
    program->Set("relief", TextureUnit::kRelief);
    program->Set("blends", HasBlendedLayers(*frame.head.surface));
    program->Set("brightness", frame.lamp_brightness);
    program->Set("rest_to_world", frame.rest_to_world);
    program->Set("photo_light", frame.head.surface->portrait.light);
    program->Set("lips_apart", glm::smoothstep(0.4f, 2.5f, mouth.gap_mm()));
    // The photo is darkened below the chin; without one, nothing lies below it.
    constexpr float kBelowAll = -1e4f;  // millimetres
    program->Set("chin_y", frame.head.chin_y.value_or(kBelowAll));
    program->Set("chin_drop", mouth.jaw_drop_mm());
  }
}

void PhotoMaterial::Use(const DrawnPart& drawn, const HeadDescription& head, bool creased) const {
  // Skin that does not crease in this frame shows the plain photo.
  const bool plain = drawn.detail == SkinDetail::kCreased && !creased && programs_[0];
  std::size_t detail = plain ? 0 : static_cast<std::size_t>(drawn.detail);
  // A coarse triangle may have less detail than all the fine ones it replaces, whose program draws
  // it as well.
  while (!programs_[detail]) ++detail;
  const GlProgram& program = *programs_[detail];
  const bool cut_out = drawn.part.material == Material::kTextured;
  // Where the sheet continues the skin, the skin wins, however coarse the sheet is.
  constexpr float kDepthOffsetMm = 5;
  program.Use();
  program.Set("lashes", drawn.part.material == Material::kShutLash);
  program.Set("cut_out", cut_out);
  program.Set("depth_offset_mm",
              cut_out && HasBlendedLayers(*head.surface) ? kDepthOffsetMm : 0.0f);
}

}  // namespace fsm
