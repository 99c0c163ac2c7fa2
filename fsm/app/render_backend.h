#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "fsm/film/film_writer.h"
#include "fsm/render/scene.h"
#include "fsm/rig/face_state.h"
#include "fsm/rig/simulation.h"
#include "vm_protocol/core/result.h"
#include "vm_protocol/core/scheduler.h"

namespace fsm {

/// Where states of the face become pictures, and where pictures and films are kept: everything the
/// module needs of graphics and files, behind one interface so that it is tested without either.
/// Thread: the module's.
class RenderBackend {
 public:
  virtual ~RenderBackend() = default;

  /// How the face came to where it is: what it looked like at earlier times.
  struct StateHistory {
    vm::Time now;
    Simulation::StateAt state_at;
  };
  /// Draws a state; the picture can then be read or shown. `history`: by it swings what hangs on
  /// springs, if it is given. Error: kUnavailable if there is no way to draw (the first call makes
  /// the graphics context of a headless backend).
  virtual vm::Result<void> Draw(const FaceState& state, const Scene& scene,
                                const StateHistory* history) = 0;
  /// Something still swings, though the face may stand still.
  virtual bool Swings() const { return false; }
  /// The frame drawn last; valid until the next call. REQUIRES: one was drawn.
  virtual const Image& Read() = 0;
  /// Begins to bring the frame drawn last to memory while others are drawn. Returns what EndRead
  /// and DropRead know it by. REQUIRES: as Read.
  virtual std::uint64_t BeginRead() = 0;
  /// The same picture as Read; waits until it is there. Frames may end in any order. Error:
  /// kUnavailable if the graphics context lost it.
  virtual vm::Result<void> EndRead(std::uint64_t frame, Image& out) = 0;
  virtual void DropRead(std::uint64_t frame) = 0;
  /// What the mouth of a state measures. Needs no drawing, but the head: the first call makes it.
  /// Error: kUnavailable if the head cannot be made.
  virtual vm::Result<MouthMeasure> Measure(const FaceState& state) = 0;

  /// The faces there are, the one worn at the start first; at least one.
  virtual std::vector<std::string> Faces() const = 0;
  /// Wears one of them from the next Draw or Measure on. Errors: kBadValue listing the names,
  /// kUnavailable if it cannot be made; the face worn stays on.
  virtual vm::Result<void> Wear(const std::string& face) = 0;

  virtual int width() const = 0;
  virtual int height() const = 0;
  virtual vm::Result<void> Resize(int width, int height) = 0;

  virtual bool has_window() const = 0;
  /// The window fills its screen, or no longer. Error: kUnavailable if there is no window.
  virtual vm::Result<void> FillScreen(bool /*fill*/) {
    return vm::Fail(vm::Errc::kUnavailable, "there is no window to fill the screen with");
  }
  /// Shows the frame drawn last and takes the window's events. REQUIRES: has_window().
  virtual void Show() = 0;
  virtual bool close_requested() const = 0;

  virtual vm::Result<void> WritePicture(const Image& image, const std::string& path) = 0;
  virtual vm::Result<Image> ReadPicture(const std::string& path) = 0;
  virtual vm::Result<std::unique_ptr<FilmWriter>> OpenFilm(const std::string& path, int width,
                                                           int height, int frames_per_second) = 0;
};

}  // namespace fsm
