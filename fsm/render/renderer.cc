#include "fsm/render/renderer.h"

#include <algorithm>
#include <cassert>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "fsm/render/appearance.h"
#include "fsm/render/backdrop.h"
#include "fsm/render/camera.h"
#include "fsm/render/figure_painter.h"
#include "fsm/render/frame_reader.h"
#include "fsm/render/gl_functions.h"
#include "fsm/render/gpu_heads.h"

namespace fsm {
namespace {

/// Returns what is drawn behind the figure.
Background Behind(const Scene& scene) {
  const bool black = scene.view_mode == ViewMode::kWireframe && scene.wire_on_black;
  const bool transparent = std::holds_alternative<Transparent>(scene.background);
  return black && !transparent ? glm::vec3(0) : scene.background;
}

/// Tells whether the processor draws, through one of Mesa's software drivers.
bool IsSoftware(const GlFunctions& gl) {
  const auto* renderer = reinterpret_cast<const char*>(gl.GetString(GL_RENDERER));
  const std::string_view name = renderer ? renderer : "";
  return name.starts_with("llvmpipe") || name.starts_with("softpipe");
}

class GlRenderer : public Renderer {
 public:
  GlRenderer(RenderContext& context, std::size_t heads, const Appearance& appearance, RigDevice rig)
      : context_(context),
        gl_(GlFunctions::Load(context)),
        draws_on_gpu_(!IsSoftware(gl_)),
        painter_(gl_, appearance, !draws_on_gpu_),
        backdrop_(gl_, appearance),
        heads_(gl_, appearance, heads),
        reader_(gl_, draws_on_gpu_ && gl_.has_compute),
        rig_on_gpu_(rig == RigDevice::kGpu ||
                    (rig == RigDevice::kBest && RigPrograms::Supported(gl_) && draws_on_gpu_)) {
    if (rig_on_gpu_ && !RigPrograms::Supported(gl_))
      throw std::runtime_error(
          "OpenGL 4.3 is needed to move faces on the card, this driver has " +
          std::string(reinterpret_cast<const char*>(gl_.GetString(GL_VERSION))));
  }

  void SetViewport(const Viewport& viewport) override { viewport_ = viewport; }
  void SetMaxErrorPixels(float pixels) override { max_error_pixels_ = pixels; }

  void DrawVertices(const Head& head, const HeadVertices& vertices, const Figure& figure,
                    const Scene& scene) override {
    DrawFrame(head, figure, scene, [&vertices](GpuHead& on_gpu) -> const HeadVertices& {
      on_gpu.arrays.Upload(vertices);
      return vertices;
    });
  }

  void Draw(const Head& head, const FaceState& state, std::span<const glm::vec3> spring_offsets,
            const Scene& scene) override {
    const Pane pane{&head, &state, &scene, viewport_, spring_offsets};
    DrawPanes({&pane, 1}, {});
  }

  void DrawPanes(std::span<const Pane> panes,
                 const std::function<void(std::size_t)>& drawn) override {
    constexpr std::ptrdiff_t kMaxAtOnce = 256;  // each takes about 0.3 MB on the GPU
    const Viewport before = viewport_;
    std::size_t done = 0;
    while (done < panes.size()) {
      const Head& head = *panes[done].head;
      auto run = panes.subspan(done);
      const auto other = std::ranges::find_if(
          run, [&head](const Pane& pane) { return pane.head->serial() != head.serial(); });
      run = run.first(static_cast<std::size_t>(std::min(other - run.begin(), kMaxAtOnce)));
      if (rig_on_gpu_) heads_.Move(head, run);
      for (std::size_t k = 0; k < run.size(); ++k, ++done) {
        viewport_ = run[k].viewport;
        DrawOne(head, run[k], k);
        if (drawn) drawn(done);
      }
    }
    viewport_ = before;
  }

  void Read(Image& out) override {
    assert(framebuffer_ && "Read before the first Draw");
    if (draws_on_gpu_) return EndRead(BeginRead(), out);
    framebuffer_->Read(out, read_options_.filter);
    if (read_options_.transparent) Unmultiply(out);
  }

  std::uint64_t BeginRead() override {
    assert(framebuffer_ && "BeginRead before the first Draw");
    return reader_.Begin(*framebuffer_, read_options_);
  }
  void EndRead(std::uint64_t frame, Image& out) override { reader_.End(frame, out); }
  void DropRead(std::uint64_t frame) override { reader_.Drop(frame); }

 private:
  /// `moved`: index among the faces of the head that were moved last.
  void DrawOne(const Head& head, const Pane& pane, std::size_t moved) {
    if (!rig_on_gpu_) {
      head.Evaluate(*pane.state, vertices_, pane.spring_offsets);
      return DrawVertices(head, vertices_, pane.state->figure, *pane.scene);
    }
    DrawFrame(head, pane.state->figure, *pane.scene,
              [moved](GpuHead& on_gpu) -> const HeadVertices& {
                return on_gpu.rig->Use(moved, on_gpu.arrays);
              });
  }

  /// `move`: binds the buffers to the frame's vertices and returns those that are measured.
  void DrawFrame(const Head& head, const Figure& figure, const Scene& scene, const auto& move) {
    const int width = viewport_.width > 0 ? viewport_.width : context_.width();
    const int height = viewport_.width > 0 ? viewport_.height : context_.height();
    UseFramebuffer(width, height);
    framebuffer_->Bind();
    // A photo is soft, so hard edges beside it would stand out. Single hairs are thinner than a
    // pixel and would become rows of dots.
    const bool soft = HasBlendedLayers(head.surface()) || !head.surface().strands.empty();
    read_options_ = {soft ? Filter::kSoft : Filter::kBox,
                     std::holds_alternative<Transparent>(scene.background)};
    const Background behind = Behind(scene);
    backdrop_.Draw(behind, width, height);
    const float alpha = std::clamp(figure.alpha, 0.0f, 1.0f);
    if (figure.enabled && alpha > 0) {
      GpuHead& on_gpu = heads_.Acquire(head);
      const HeadVertices& vertices = move(on_gpu);
      painter_.Draw(head, on_gpu, vertices,
                    ViewOfPortrait(figure, scene.camera, width, height, head.view()), scene,
                    max_error_pixels_, *framebuffer_);
      // The figure fades as one picture; blending each of its layers would show what is behind
      // them.
      if (alpha < 1) backdrop_.BlendOver(behind, 1 - alpha);
    }
    if (context_.is_window()) {
      gl_.BindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
      framebuffer_->Show(viewport_.x,
                         viewport_.width > 0 ? context_.height() - viewport_.y - height : 0);
    }
  }

  /// Panes of several sizes alternate, so the framebuffers of the last few sizes are kept.
  void UseFramebuffer(int width, int height) {
    constexpr std::size_t kMax = 4;
    const auto fits = [&](const auto& framebuffer) {
      return framebuffer->width() == width && framebuffer->height() == height;
    };
    auto found = std::ranges::find_if(framebuffers_, fits);
    if (found == framebuffers_.end()) {
      if (framebuffers_.size() >= kMax) framebuffers_.pop_back();
      framebuffers_.push_back(std::make_unique<GlFramebuffer>(gl_, width, height));
      found = std::prev(framebuffers_.end());
    }
    std::rotate(framebuffers_.begin(), found, std::next(found));
    framebuffer_ = framebuffers_.front().get();
  }

  RenderContext& context_;
  Viewport viewport_;
  float max_error_pixels_ = 0;
  GlFunctions gl_;
  const bool draws_on_gpu_;
  FigurePainter painter_;
  Backdrop backdrop_;
  GpuHeads heads_;
  std::vector<std::unique_ptr<GlFramebuffer>> framebuffers_;  // last used first
  FrameReader reader_;
  const bool rig_on_gpu_;
  HeadVertices vertices_;  // result of moving a head on the processor; reused
  // The framebuffer of the last frame.
  GlFramebuffer* framebuffer_ = nullptr;
  ReadOptions read_options_;
};

}  // namespace

std::unique_ptr<Renderer> Renderer::Make(RenderContext& context, std::size_t heads) {
  return Make(context, heads, Appearance::BuiltIn());
}

std::unique_ptr<Renderer> Renderer::Make(RenderContext& context, std::size_t heads,
                                         const Appearance& appearance, RigDevice rig) {
  return std::make_unique<GlRenderer>(context, std::max<std::size_t>(heads, 1), appearance, rig);
}

}  // namespace fsm
