#include "fsm/render/figure_painter.h"

#include <cstdint>

namespace fsm {
namespace {

bool IsDrawnFromBothSides(const HeadSurface::Part& part) {
  return part.two_sided || HasTwoSides(part.material);
}

}  // namespace

void FigurePainter::Draw(const Head& head, GpuHead& on_gpu, const HeadVertices& vertices,
                         const FrameCamera& view, const Scene& scene, float error_pixels,
                         GlFramebuffer& framebuffer) {
  gl_.Enable(GL_DEPTH_TEST);
  gl_.Clear(GL_DEPTH_BUFFER_BIT);
  materials_.BeginFrame(view, on_gpu, vertices, scene);
  const bool lines = scene.view_mode != ViewMode::kTexture;
  const float error_mm = error_pixels * kSamplesAlong / view.samples_per_mm;
  const auto& parts = on_gpu.arrays.PartsWithin(head, lines ? 0 : error_mm);
  if (on_gpu.description.skin.painting()) WarmUp(parts, framebuffer);
  on_gpu.textures.Load(on_gpu.description, view.samples_per_mm);
  if (scene.view_mode == ViewMode::kTextureWithWireframe) {
    gl_.Enable(GL_POLYGON_OFFSET_FILL);
    gl_.PolygonOffset(1.5f, 2.0f);
  }
  if (scene.view_mode != ViewMode::kWireframe) DrawParts(parts);
  gl_.Disable(GL_POLYGON_OFFSET_FILL);
  if (lines) DrawLines(parts, scene);
  gl_.Disable(GL_BLEND);
  gl_.Disable(GL_DEPTH_TEST);
}

void FigurePainter::DrawParts(const std::vector<DrawnPart>& parts) {
  gl_.CullFace(GL_BACK);
  for (const DrawnPart& drawn : parts) {
    if (materials_.IsHidden(drawn)) continue;
    (IsDrawnFromBothSides(drawn.part) ? gl_.Disable : gl_.Enable)(GL_CULL_FACE);
    materials_.Use(drawn);
    if (drawn.blended) BeginBlending();
    DrawTriangles(drawn.part);
    if (drawn.blended) gl_.Disable(GL_BLEND);
    // A software driver draws on its own threads, but starts only when flushed.
    if (software_ && &drawn == &parts.front()) gl_.Flush();
  }
  gl_.Disable(GL_CULL_FACE);
}

/// A software driver compiles a shader on first use, which takes far longer than a frame. It is
/// made to do so while the skin is painted: one invisible triangle of each part, with and without
/// creases.
void FigurePainter::WarmUp(const std::vector<DrawnPart>& parts, GlFramebuffer& framebuffer) {
  gl_.Viewport(0, 0, 0, 0);
  gl_.CullFace(GL_BACK);
  const bool creased = materials_.creased();
  for (const bool variant : {!creased, creased}) {
    materials_.SetCreased(variant);
    for (DrawnPart drawn : parts) {
      drawn.part.index_count = 3;
      (IsDrawnFromBothSides(drawn.part) ? gl_.Disable : gl_.Enable)(GL_CULL_FACE);
      materials_.Use(drawn);
      DrawTriangles(drawn.part);
    }
  }
  gl_.Disable(GL_CULL_FACE);
  framebuffer.Bind();
  gl_.Clear(GL_DEPTH_BUFFER_BIT);
}

void FigurePainter::DrawLines(const std::vector<DrawnPart>& parts, const Scene& scene) {
  const bool alone = scene.view_mode == ViewMode::kWireframe;
  const glm::vec4 colour = alone ? glm::vec4(scene.wire, 1.0f) : appearance_.line_over_texture;
  BeginBlending();
  gl_.DepthFunc(GL_LEQUAL);
  gl_.PolygonMode(GL_FRONT_AND_BACK, GL_LINE);
  gl_.Enable(GL_CULL_FACE);
  gl_.CullFace(GL_BACK);
  materials_.UseLine(colour);
  for (const DrawnPart& drawn : parts) DrawTriangles(drawn.part);
  gl_.Disable(GL_CULL_FACE);
  gl_.PolygonMode(GL_FRONT_AND_BACK, GL_FILL);
  gl_.DepthFunc(GL_LESS);
}

void FigurePainter::BeginBlending() {
  gl_.Enable(GL_BLEND);
  gl_.BlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
}

void FigurePainter::DrawTriangles(const HeadSurface::Part& part) {
  const auto offset = static_cast<std::uintptr_t>(part.first_index) * sizeof(std::uint32_t);
  gl_.DrawElements(GL_TRIANGLES, static_cast<GLsizei>(part.index_count), GL_UNSIGNED_INT,
                   reinterpret_cast<const void*>(offset));
}

}  // namespace fsm
