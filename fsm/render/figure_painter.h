#pragma once

#include <vector>

#include "fsm/render/camera.h"
#include "fsm/render/gl_objects.h"
#include "fsm/render/gpu_heads.h"
#include "fsm/render/materials.h"

namespace fsm {

/// Draws a head into the bound framebuffer: its parts by their materials, its mesh as lines.
/// Destroy while its context is current.
class FigurePainter {
 public:
  /// `software`: whether the processor draws, through one of Mesa's software drivers. `gl` and
  /// `appearance` must outlive it.
  FigurePainter(const GlFunctions& gl, const Appearance& appearance, bool software)
      : gl_(gl), appearance_(appearance), software_(software), materials_(gl, appearance) {}
  /// `vertices`: those that on_gpu.arrays is bound to, at least the measured ones.
  /// `error_pixels`: see Renderer::SetMaxErrorPixels.
  void Draw(const Head& head, GpuHead& on_gpu, const HeadVertices& vertices,
            const FrameCamera& view, const Scene& scene, float error_pixels,
            GlFramebuffer& framebuffer);

 private:
  void DrawParts(const std::vector<DrawnPart>& parts);
  void DrawLines(const std::vector<DrawnPart>& parts, const Scene& scene);
  void WarmUp(const std::vector<DrawnPart>& parts, GlFramebuffer& framebuffer);
  void BeginBlending();
  void DrawTriangles(const HeadSurface::Part& part);

  const GlFunctions& gl_;
  const Appearance& appearance_;
  const bool software_;
  Materials materials_;
};

}  // namespace fsm
