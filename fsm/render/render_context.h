#pragma once

#include <memory>
#include <string>

namespace fsm {

/// What draws off screen. The order in which ways are tried stands in headless_context.cc.
enum class OffScreen {
  kOsMesa,  ///< Mesa's software: OSMesa, or its software device where there is no OSMesa
  kEgl,     ///< a graphics card by EGL; else what Mesa has, which may be software
  kAny      ///< as kEgl; where EGL has nothing, OSMesa
};

/// A GL context and where its frames go.
/// Thread: the one that made it. At most one context is current there. Making a context makes it
///         current; destroying a context that is not current leaves the current one as it is.
class RenderContext {
 public:
  virtual ~RenderContext() = default;
  /// Off screen; throws std::runtime_error with a sentence if it cannot be had.
  static std::unique_ptr<RenderContext> MakeHeadless(int width, int height,
                                                     OffScreen how = OffScreen::kOsMesa);
  /// A window; throws if there is no display.
  static std::unique_ptr<RenderContext> MakeWindow(int width, int height, const std::string& title);
  /// Window: fills the screen it is on, or goes back to its size and place. Else nothing.
  virtual void SetFullScreen(bool /*full*/) {}
  /// Window: moves its upper left corner, where the window system lets it. Else nothing.
  virtual void Move(int /*x*/, int /*y*/) {}
  /// Another size of the drawable. That of a window follows when the window system grants it.
  virtual void Resize(int width, int height) = 0;
  virtual void MakeCurrent() = 0;
  virtual void* GetProcAddress(const char* name) = 0;
  /// The way that led to it, as "OSMesa" or "EGL, device 0 (/dev/dri/card0), hardware".
  virtual std::string reached_by() const { return "unknown means"; }
  virtual int width() const = 0;  ///< of the drawable now (a window may be resized)
  virtual int height() const = 0;
  virtual bool is_window() const = 0;
  /// Shows the frame drawn (window), and takes the window's events.
  virtual void Present() = 0;
  virtual bool close_requested() const = 0;
};

/// GL_RENDERER, GL_VERSION and the way of what would draw off screen, one line: "llvmpipe (LLVM
/// 15.0.6, 256 bits), OpenGL 4.5 (...), by OSMesa"; "none: ..." with the reason if nothing would.
/// Makes a context and destroys it.
std::string DescribeOffScreen(OffScreen how);

}  // namespace fsm
