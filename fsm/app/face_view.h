#pragma once

#include <cstdint>

#include "fsm/image/image.h"
#include "fsm/render/scene.h"
#include "fsm/rig/face_state.h"
#include "fsm/rig/simulation.h"
#include "vm_protocol/core/result.h"
#include "vm_protocol/core/scheduler.h"

namespace fsm {

/// The window that shows a view. Thread: the module's.
class ViewWindow {
 public:
  virtual ~ViewWindow() = default;
  /// Switches full screen on or off.
  virtual void FillScreen(bool fill) = 0;
  /// Shows the frame drawn last and handles the window's events.
  virtual void Show() = 0;
  virtual bool close_requested() const = 0;
};

/// Draws the current face in frames of one size, which can be read or shown in a window.
/// Thread: the module's.
class FaceView {
 public:
  virtual ~FaceView() = default;

  /// The states of the face up to now, from which the motion of springs is simulated.
  struct StateHistory {
    vm::Time now;
    Simulation::StateAt state_at;
  };
  /// Draws a state. `history`: moves the springs, if not null. Error: kUnavailable if nothing can
  /// be drawn (without a window the first call creates the graphics context).
  virtual vm::Result<void> Draw(const FaceState& state, const Scene& scene,
                                const StateHistory* history) = 0;
  /// Tells whether springs still move, even if the face is still.
  virtual bool Swings() const { return false; }

  /// Returns the frame drawn last; valid until the next call. REQUIRES: one was drawn.
  virtual const Image& Read() = 0;
  /// Begins to copy the frame drawn last to memory while others are drawn. Returns its handle for
  /// EndRead and DropRead. REQUIRES: as Read.
  virtual std::uint64_t BeginRead() = 0;
  /// Waits for a frame of BeginRead and returns in `out` the same picture as Read. Frames may be
  /// ended in any order. Error: kUnavailable if the graphics context lost it.
  virtual vm::Result<void> EndRead(std::uint64_t frame, Image& out) = 0;
  virtual void DropRead(std::uint64_t frame) = 0;

  virtual int width() const = 0;  ///< in pixels; changes if the user resizes a window
  virtual int height() const = 0;
  virtual vm::Result<void> Resize(int width, int height) = 0;
  /// Returns null if there is no window.
  virtual ViewWindow* window() { return nullptr; }
};

}  // namespace fsm
