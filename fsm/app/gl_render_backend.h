#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "fsm/app/render_backend.h"
#include "fsm/faces/original_faces.h"
#include "fsm/film/film_writer.h"
#include "fsm/head/make_head.h"
#include "fsm/render/appearance.h"
#include "fsm/render/renderer.h"
#include "fsm/rig/head.h"

namespace fsm {

/// Draws our head with OpenGL: in a window, or headless with a context made at the first need.
class GlRenderBackend final : public RenderBackend {
 public:
  struct Options {
    int width = 640;
    int height = 480;
    enum class Where { kHeadless, kWindow, kWindowIfPossible } where = Where::kHeadless;
    std::string title = "Galatea";
    OffScreen off_screen = OffScreen::kOsMesa;  ///< of the context without a window
    RigOn rig = RigOn::kBest;
    std::optional<std::pair<int, int>> position = {};  ///< of the window's upper left corner
    /// Faces beside the built-in ones and those of the faces folder, listed before them.
    std::vector<NamedFace> more_faces = {};
    /// A folder that may have units, features (see MakeHeadOfName) and an appearance of one's own.
    std::string tables = {};
  };
  /// Throws std::runtime_error with a sentence if a window is asked for and cannot be had, or if
  /// appearance.txt is wrong.
  explicit GlRenderBackend(const Options& options);
  ~GlRenderBackend() override;

  vm::Result<void> Draw(const FaceState& state, const Scene& scene,
                        const StateHistory* history) override;
  bool Swings() const override { return simulation_ && !simulation_->Still(); }
  const Image& Read() override;
  std::uint64_t BeginRead() override;
  vm::Result<void> EndRead(std::uint64_t frame, Image& out) override;
  void DropRead(std::uint64_t frame) override;
  vm::Result<MouthMeasure> Measure(const FaceState& state) override;
  std::vector<std::string> Faces() const override;
  vm::Result<void> Wear(const std::string& face) override;
  int width() const override;
  int height() const override;
  vm::Result<void> Resize(int width, int height) override;
  bool has_window() const override;
  vm::Result<void> FillScreen(bool fill) override;
  void Show() override;
  bool close_requested() const override;
  vm::Result<void> WritePicture(const Image& image, const std::string& path) override;
  vm::Result<Image> ReadPicture(const std::string& path) override;
  vm::Result<std::unique_ptr<FilmWriter>> OpenFilm(const std::string& path, int width, int height,
                                                   int frames_per_second) override;

 private:
  const Head& head();
  std::unique_ptr<Head> MakeNamedHead(const std::string& face) const;
  void MakeRenderer();
  std::span<const glm::vec3> Swing(const StateHistory* history);

  Options options_;
  std::optional<Appearance> appearance_;  // in place of the built-in one
  std::string face_;                      // worn; "" = the first
  std::unique_ptr<Head> head_;  // made at the first need, as drawing may never be asked for
  std::unique_ptr<RenderContext> context_;
  std::unique_ptr<Renderer> renderer_;  // lives in the context
  /// Moves the springs of the head drawn last; none if nothing is to swing.
  std::optional<Simulation> simulation_;
  std::uint64_t simulated_ = 0;  // serial of that head
  Image image_;
};

}  // namespace fsm
