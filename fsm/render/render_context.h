#pragma once

#include <memory>
#include <string>

namespace fsm {

/// The preferred way to draw off screen. headless_context.cc has the order in which ways are tried.
enum class OffScreenDriver {
  kOsMesa,  ///< Mesa's software renderer: OSMesa, or its software device if there is no OSMesa
  kEgl,     ///< a GPU through EGL; else Mesa's EGL, which may be software
  kAny      ///< as kEgl, then OSMesa if EGL finds nothing
};

/// A GL context and the target of its frames.
/// Thread: the one that made it. At most one context is current there. Making a context makes it
///         current; destroying a context that is not current leaves the current one as it is.
class RenderContext {
 public:
  virtual ~RenderContext() = default;
  /// Makes an off-screen context; throws std::runtime_error with a sentence on failure.
  static std::unique_ptr<RenderContext> MakeHeadless(
      int width, int height, OffScreenDriver how = OffScreenDriver::kOsMesa);
  /// Makes a window; throws std::runtime_error if there is no display.
  static std::unique_ptr<RenderContext> MakeWindow(int width, int height, const std::string& title);
  /// Makes a window fill its screen, or restores its size and position. Does nothing off screen.
  virtual void SetFullScreen(bool /*full*/) {}
  /// Moves a window's upper left corner, if the window system permits. Does nothing off screen.
  virtual void Move(int /*x*/, int /*y*/) {}
  /// Resizes the drawable. A window changes when the window system grants it.
  virtual void Resize(int width, int height) = 0;
  virtual void MakeCurrent() = 0;
  virtual void* GetProcAddress(const char* name) = 0;
  /// Returns how it was made, as "OSMesa" or "EGL, device 0 (/dev/dri/card0), hardware".
  virtual std::string description() const { return "unknown means"; }
  virtual int width() const = 0;  ///< current size of the drawable (a window may be resized)
  virtual int height() const = 0;
  virtual bool is_window() const = 0;
  /// Shows the drawn frame in a window and handles the window's events.
  virtual void Present() = 0;
  virtual bool close_requested() const = 0;
};

/// Returns one line with GL_RENDERER, GL_VERSION and the way of an off-screen context: "llvmpipe
/// (LLVM 15.0.6, 256 bits), OpenGL 4.5 (...), by OSMesa"; "none: ..." with the reason on failure.
/// Makes a context and destroys it.
std::string DescribeOffScreen(OffScreenDriver how);

}  // namespace fsm
