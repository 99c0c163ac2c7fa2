#include "fsm/render/renderer.h"

#include <algorithm>
#include <cassert>
#include <map>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "fsm/render/appearance.h"
#include "fsm/render/backdrop.h"
#include "fsm/render/camera.h"
#include "fsm/render/frame_reader.h"
#include "fsm/render/gl_functions.h"
#include "fsm/render/gl_objects.h"
#include "fsm/render/gpu_rig.h"
#include "fsm/render/head_buffers.h"
#include "fsm/render/materials.h"
#include "fsm/rig/partial_rig.h"

namespace fsm {
namespace {

/// Returns the scene whose background is drawn behind the figure.
Scene Behind(const Scene& scene) {
  Scene behind = scene;
  if (scene.view_mode == ViewMode::kWireframe && scene.wire_on_black) {
    behind.background = glm::vec3(0);
    behind.background_image = nullptr;
  }
  return behind;
}

bool IsDrawnFromBothSides(const HeadTopology::Part& part) {
  using enum Material;
  const Material material = part.material;
  return part.two_sided || material == kLash || material == kShutLash || material == kMouthInside ||
         material == kMatte;
}

/// Tells whether the processor draws, through one of Mesa's software drivers.
bool IsSoftware(const GlFunctions& gl) {
  const auto* renderer = reinterpret_cast<const char*>(gl.GetString(GL_RENDERER));
  const std::string_view name = renderer ? renderer : "";
  return name.starts_with("llvmpipe") || name.starts_with("softpipe");
}

/// A head that a graphics card moves. The vertices that the frame needs to know are computed on the
/// processor as well, which is faster than reading them back.
class CardRig {
 public:
  CardRig(const GlFunctions& gl, RigPrograms& programs, const Head& head,
          std::vector<std::uint32_t> measured)
      : rig_(gl, programs, head.rig()), partial_(head.rig(), std::move(measured)) {}
  void Move(const Head& head, std::span<const Renderer::Pane> panes) {
    faces_.clear();
    for (const Renderer::Pane& pane : panes) faces_.push_back({pane.state, pane.swings});
    rig_.Evaluate(head.rig(), faces_);
  }
  /// Binds `buffers` to one of the faces moved last; returns the positions that are measured.
  const HeadVertices& Use(std::size_t face, HeadBuffers& buffers) {
    buffers.Use(rig_.positions(), rig_.normals(), rig_.OffsetBytes(face));
    partial_.Evaluate(*faces_[face].state, seen_, faces_[face].swings);
    return seen_;
  }

 private:
  GpuRig rig_;
  PartialRig partial_;
  std::vector<GpuRig::Input> faces_;  // those moved last
  HeadVertices seen_;
};

class GlRenderer : public Renderer {
 public:
  GlRenderer(RenderContext& context, std::size_t heads, const Appearance& appearance, RigOn rig)
      : context_(context),
        most_heads_(heads),
        appearance_(appearance),
        gl_(GlFunctions::Load(context)),
        materials_(gl_, appearance),
        backdrop_(gl_, appearance_),
        draws_on_card_(!IsSoftware(gl_)),
        reader_(gl_, draws_on_card_ && gl_.has_compute),
        rig_programs_(gl_),
        rig_on_card_(rig == RigOn::kCard ||
                     (rig == RigOn::kBest && RigPrograms::Supported(gl_) && draws_on_card_)) {
    if (rig_on_card_ && !RigPrograms::Supported(gl_))
      throw std::runtime_error(
          "OpenGL 4.3 is needed to move faces on the card, this driver has " +
          std::string(reinterpret_cast<const char*>(gl_.GetString(GL_VERSION))));
  }

  void SetViewport(const Viewport& viewport) override { viewport_ = viewport; }
  void SetFormError(float pixels) override { form_error_ = pixels; }

  void Draw(const Head& head, const HeadVertices& vertices, const FaceState& state,
            const Scene& scene) override {
    DrawFrame(head, state, scene, [&vertices](HeadOnCard& on_card) -> const HeadVertices& {
      on_card.buffers.Upload(vertices);
      return vertices;
    });
  }

  void Draw(const Head& head, const FaceState& state, std::span<const glm::vec3> swings,
            const Scene& scene) override {
    const Pane pane{&head, &state, &scene, viewport_, swings};
    Draw({&pane, 1}, {});
  }

  void Draw(std::span<const Pane> panes, const std::function<void(std::size_t)>& drawn) override {
    constexpr std::ptrdiff_t kMostAtOnce = 256;  // each takes about 0.3 MB on the card
    const Viewport before = viewport_;
    std::size_t done = 0;
    while (done < panes.size()) {
      const Head& head = *panes[done].head;
      auto run = panes.subspan(done);
      const auto other = std::ranges::find_if(
          run, [&head](const Pane& pane) { return pane.head->serial() != head.serial(); });
      run = run.first(static_cast<std::size_t>(std::min(other - run.begin(), kMostAtOnce)));
      if (rig_on_card_) Move(head, run);
      for (std::size_t k = 0; k < run.size(); ++k, ++done) {
        viewport_ = run[k].viewport;
        DrawOne(head, run[k], k);
        if (drawn) drawn(done);
      }
    }
    viewport_ = before;
  }

  void Read(Image& out) override {
    assert(target_ && "Read before the first Draw");
    if (draws_on_card_) return EndRead(BeginRead(), out);
    target_->Read(out, soft_);
    if (transparent_) Unmultiply(out);
  }

  std::uint64_t BeginRead() override {
    assert(target_ && "BeginRead before the first Draw");
    return reader_.Begin(*target_, soft_, transparent_);
  }
  void EndRead(std::uint64_t frame, Image& out) override { reader_.End(frame, out); }
  void DropRead(std::uint64_t frame) override { reader_.Drop(frame); }

 private:
  /// What the card holds for one head.
  struct HeadOnCard {
    HeadOnCard(const GlFunctions& gl, const Head& head, const Appearance& appearance)
        : buffers(gl, head, appearance), textures(gl, head.topology()) {}
    HeadBuffers buffers;
    HeadTextures textures;
    std::optional<CardRig> rig;
    std::uint64_t drawn = 0;  ///< number of the last frame that showed it
  };

  void Move(const Head& head, std::span<const Pane> panes) {
    HeadOnCard& on_card = Find(head);
    if (!on_card.rig)
      on_card.rig.emplace(gl_, rig_programs_, head, on_card.buffers.MeasuredVertices());
    on_card.rig->Move(head, panes);
  }

  /// `moved`: index among the faces of the head that were moved last.
  void DrawOne(const Head& head, const Pane& pane, std::size_t moved) {
    if (!rig_on_card_) {
      head.Evaluate(*pane.state, vertices_, pane.swings);
      return Draw(head, vertices_, *pane.state, *pane.scene);
    }
    DrawFrame(head, *pane.state, *pane.scene, [moved](HeadOnCard& on_card) -> const HeadVertices& {
      return on_card.rig->Use(moved, on_card.buffers);
    });
  }

  /// `move`: binds the buffers to the frame's vertices and returns those that are measured.
  void DrawFrame(const Head& head, const FaceState& state, const Scene& scene, const auto& move) {
    const int width = viewport_.width > 0 ? viewport_.width : context_.width();
    const int height = viewport_.width > 0 ? viewport_.height : context_.height();
    FindTarget(width, height);
    target_->Bind();
    // A photo is soft, so hard edges beside it would stand out.
    soft_ = HasSoftLayers(head.topology());
    transparent_ = !scene.show_background;
    const Scene behind = Behind(scene);
    backdrop_.Draw(behind, width, height);
    const float alpha = std::clamp(state.figure.alpha, 0.0F, 1.0F);
    if (state.figure.enabled && alpha > 0) {
      DrawFigure(head, state, scene, move);
      // The figure fades as one picture; blending each of its layers would show what is behind
      // them.
      if (alpha < 1) backdrop_.Veil(behind, 1 - alpha);
    }
    if (context_.is_window()) {
      gl_.BindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
      target_->Show(viewport_.x,
                    viewport_.width > 0 ? context_.height() - viewport_.y - height : 0);
    }
  }

  HeadOnCard& Find(const Head& head) {
    auto found = heads_.find(head.serial());
    if (found == heads_.end()) {
      if (heads_.size() >= most_heads_) {
        heads_.erase(std::ranges::min_element(
            heads_, {}, [](const auto& entry) { return entry.second->drawn; }));
      }
      found =
          heads_.emplace(head.serial(), std::make_unique<HeadOnCard>(gl_, head, appearance_)).first;
    }
    found->second->drawn = ++frames_;
    return *found->second;
  }

  /// Panes of several sizes alternate, so the targets of the last few sizes are kept.
  void FindTarget(int width, int height) {
    constexpr std::size_t kMost = 4;
    const auto fits = [&](const auto& target) {
      return target->width() == width && target->height() == height;
    };
    auto found = std::ranges::find_if(targets_, fits);
    if (found == targets_.end()) {
      if (targets_.size() >= kMost) targets_.pop_back();
      targets_.push_back(std::make_unique<GlTarget>(gl_, width, height));
      found = std::prev(targets_.end());
    }
    std::rotate(targets_.begin(), found, std::next(found));
    target_ = targets_.front().get();
  }

  void DrawFigure(const Head& head, const FaceState& state, const Scene& scene, const auto& move) {
    const View view =
        ViewOfPortrait(state.figure, scene.camera, target_->width(), target_->height());
    HeadOnCard& on_card = Find(head);
    HeadBuffers& buffers = on_card.buffers;
    const HeadVertices& vertices = move(on_card);
    gl_.Enable(GL_DEPTH_TEST);
    gl_.Clear(GL_DEPTH_BUFFER_BIT);
    materials_.BeginFrame(view, buffers, on_card.textures, vertices, scene);
    const bool lines = scene.view_mode != ViewMode::kTexture;
    const float error_mm = form_error_ * kSamplesAlong / view.samples_per_mm;
    const auto& parts = buffers.PartsWithin(head, lines ? 0 : error_mm);
    if (buffers.painting()) WarmUp(parts);
    on_card.textures.Load(buffers, view.samples_per_mm);
    if (scene.view_mode != ViewMode::kWireframe) {
      if (scene.view_mode == ViewMode::kTextureWithWireframe) {
        gl_.Enable(GL_POLYGON_OFFSET_FILL);
        gl_.PolygonOffset(1.5F, 2.0F);
      }
      gl_.CullFace(GL_BACK);
      for (const DrawnPart& part : parts) {
        if (materials_.IsHidden(part)) continue;
        // Lashes are two-sided. All other parts are closed surfaces, or hair, which has its own
        // inner side where it hangs.
        (IsDrawnFromBothSides(part.part) ? gl_.Disable : gl_.Enable)(GL_CULL_FACE);
        materials_.Use(part);
        if (part.soft) BeginBlending();
        DrawPart(part.part);
        if (part.soft) gl_.Disable(GL_BLEND);
        // A software driver draws on its own threads, but starts only when flushed.
        if (!draws_on_card_ && &part == &parts.front()) gl_.Flush();
      }
      gl_.Disable(GL_CULL_FACE);
      gl_.Disable(GL_POLYGON_OFFSET_FILL);
    }
    if (lines) DrawLines(parts, scene);
    gl_.Disable(GL_BLEND);
    gl_.Disable(GL_DEPTH_TEST);
  }

  /// A software driver compiles a shader on first use, which takes far longer than a frame. It is
  /// made to do so while the skin is painted: one invisible triangle of each part, with and without
  /// creases.
  void WarmUp(const std::vector<DrawnPart>& parts) {
    gl_.Viewport(0, 0, 0, 0);
    gl_.CullFace(GL_BACK);
    const bool creased = materials_.creased();
    for (const bool variant : {!creased, creased}) {
      materials_.SetCreased(variant);
      for (auto part : parts) {
        part.part.index_count = 3;
        (IsDrawnFromBothSides(part.part) ? gl_.Disable : gl_.Enable)(GL_CULL_FACE);
        materials_.Use(part);
        DrawPart(part.part);
      }
    }
    gl_.Disable(GL_CULL_FACE);
    target_->Bind();
    gl_.Clear(GL_DEPTH_BUFFER_BIT);
  }

  void DrawLines(const std::vector<DrawnPart>& parts, const Scene& scene) {
    const bool alone = scene.view_mode == ViewMode::kWireframe;
    const glm::vec4 colour = alone ? glm::vec4(scene.wire, 1.0F) : appearance_.line_over_texture;
    BeginBlending();
    gl_.DepthFunc(GL_LEQUAL);
    gl_.PolygonMode(GL_FRONT_AND_BACK, GL_LINE);
    gl_.Enable(GL_CULL_FACE);
    gl_.CullFace(GL_BACK);
    materials_.UseLine(colour);
    for (const auto& part : parts) DrawPart(part.part);
    gl_.Disable(GL_CULL_FACE);
    gl_.PolygonMode(GL_FRONT_AND_BACK, GL_FILL);
    gl_.DepthFunc(GL_LESS);
  }

  void BeginBlending() {
    gl_.Enable(GL_BLEND);
    gl_.BlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  }

  void DrawPart(const HeadTopology::Part& part) {
    const auto offset = static_cast<std::uintptr_t>(part.first_index) * sizeof(std::uint32_t);
    gl_.DrawElements(GL_TRIANGLES, static_cast<GLsizei>(part.index_count), GL_UNSIGNED_INT,
                     reinterpret_cast<const void*>(offset));
  }

  RenderContext& context_;
  const std::size_t most_heads_;
  Viewport viewport_;
  float form_error_ = 0;  // pixels
  const Appearance& appearance_;
  GlFunctions gl_;
  Materials materials_;
  Backdrop backdrop_;
  std::map<std::uint64_t, std::unique_ptr<HeadOnCard>> heads_;  // by Head::serial
  std::uint64_t frames_ = 0;
  std::vector<std::unique_ptr<GlTarget>> targets_;  // last used first
  const bool draws_on_card_;
  FrameReader reader_;
  RigPrograms rig_programs_;
  const bool rig_on_card_;
  HeadVertices vertices_;  // result of moving a head on the processor; reused
  // The target of the last frame.
  GlTarget* target_ = nullptr;
  bool soft_ = false;
  bool transparent_ = false;
};

}  // namespace

std::unique_ptr<Renderer> Renderer::Make(RenderContext& context, std::size_t heads) {
  return Make(context, heads, Appearance::BuiltIn());
}

std::unique_ptr<Renderer> Renderer::Make(RenderContext& context, std::size_t heads,
                                         const Appearance& appearance, RigOn rig) {
  return std::make_unique<GlRenderer>(context, std::max<std::size_t>(heads, 1), appearance, rig);
}

}  // namespace fsm
