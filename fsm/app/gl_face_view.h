#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "fsm/app/face_view.h"
#include "fsm/app/head_library.h"
#include "fsm/base/table_folder.h"
#include "fsm/render/appearance.h"
#include "fsm/render/renderer.h"

namespace fsm {

/// Draws the current head with OpenGL, in a window or without one; the context of the latter is
/// created by the first Draw. Lifetime: `library` outlives this.
class GlFaceView final : public FaceView, private ViewWindow {
 public:
  struct Options {
    int width = 640;
    int height = 480;
    enum class WindowMode {
      kHeadless,
      kWindow,
      kWindowIfPossible
    } window_mode = WindowMode::kHeadless;
    std::string title = "Galatea";
    OffScreenDriver off_screen = OffScreenDriver::kOsMesa;  ///< used without a window
    RigDevice rig = RigDevice::kBest;
    std::optional<std::pair<int, int>> position = {};  ///< of the window's upper left corner
    TableFolder tables = {};                           ///< may contain an appearance.txt
    Log log = [](const std::string&) {};               ///< takes notices
  };
  /// Throws std::runtime_error if a required window cannot be opened, or if appearance.txt is
  /// damaged.
  GlFaceView(HeadLibrary& library, const Options& options);
  ~GlFaceView() override;

  vm::Result<void> Draw(const FaceState& state, const Scene& scene,
                        const StateHistory* history) override;
  bool Swings() const override { return simulation_ && !simulation_->Still(); }
  const Image& Read() override;
  std::uint64_t BeginRead() override;
  vm::Result<void> EndRead(std::uint64_t frame, Image& out) override;
  void DropRead(std::uint64_t frame) override;
  int width() const override { return context_ ? context_->width() : options_.width; }
  int height() const override { return context_ ? context_->height() : options_.height; }
  vm::Result<void> Resize(int width, int height) override;
  ViewWindow* window() override { return context_ && context_->is_window() ? this : nullptr; }

 private:
  void FillScreen(bool fill) override { context_->SetFullScreen(fill); }
  void Show() override { context_->Present(); }
  bool close_requested() const override { return context_->close_requested(); }

  void MakeRenderer();
  std::span<const glm::vec3> SpringOffsets(const Head& head, const StateHistory* history);

  HeadLibrary& library_;
  Options options_;
  std::optional<Appearance> appearance_;  // replaces the built-in one
  std::unique_ptr<RenderContext> context_;
  std::unique_ptr<Renderer> renderer_;  // uses the context
  /// The springs of the head drawn last; none if they do not move.
  std::optional<Simulation> simulation_;
  std::uint64_t simulated_ = 0;  // the serial number of that head
  Image image_;
};

}  // namespace fsm
