#pragma once

#include <cstdint>

#include "fsm/image/image.h"
#include "fsm/render/scene.h"
#include "fsm/rig/face_state.h"
#include "fsm/rig/simulation.h"
#include "vm_protocol/core/result.h"
#include "vm_protocol/core/scheduler.h"

namespace fsm {

/// The window in which a view is shown. Thread: the module's.
class ViewWindow {
 public:
  virtual ~ViewWindow() = default;
  /// Fills its screen, or does so no longer.
  virtual void FillScreen(bool fill) = 0;
  /// Shows the frame drawn last and takes the window's events.
  virtual void Show() = 0;
  virtual bool close_requested() const = 0;
};

/// Draws the face that is worn, in pictures of one size that can be read or shown in a window.
/// Thread: the module's.
class FaceView {
 public:
  virtual ~FaceView() = default;

  /// How the face came to where it is: what it looked like at earlier times.
  struct StateHistory {
    vm::Time now;
    Simulation::StateAt state_at;
  };
  /// Draws a state. `history`: by it swings what hangs on springs, if it is given. Error:
  /// kUnavailable if there is no way to draw (without a window the first call makes the graphics
  /// context).
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

  virtual int width() const = 0;  ///< in pixels now; the user may resize a window
  virtual int height() const = 0;
  virtual vm::Result<void> Resize(int width, int height) = 0;
  /// Null where nothing is shown.
  virtual ViewWindow* window() { return nullptr; }
};

}  // namespace fsm
