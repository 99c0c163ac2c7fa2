#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <memory>
#include <span>
#include <string>

#include "fsm/image/image.h"
#include "fsm/render/scene.h"
#include "fsm/rig/face_state.h"
#include "fsm/rig/head.h"

namespace fsm {

class Appearance;

/// What draws off screen. The order in which ways are tried stands in headless_context.cc.
enum class OffScreen {
  kOsMesa,  ///< Mesa's software: OSMesa, or its software device where a build has no OSMesa
  kEgl,     ///< a graphics card by EGL; else what Mesa has, which may be software
  kAny      ///< as kEgl; where EGL has nothing, OSMesa
};

/// A GL context and where its frames go. Thread: one, the one that made it; at most one is current,
/// and a context is current when made. Destroying one leaves another current that was so.
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
  /// Window: asks for another size of its inside, which follows when the window system grants it.
  virtual void Resize(int /*width*/, int /*height*/) {}
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

/// What moves the vertices of a head that is drawn by its state.
enum class RigOn {
  kBest,  ///< the graphics card where one draws and has compute shaders (OpenGL 4.3)
  kProcessor,
  kCard  ///< also where a card is only software's
};

/// Part of what a context draws into, in pixels from its upper left corner; width 0: all of it.
struct Viewport {
  int x = 0, y = 0;
  int width = 0, height = 0;
};

/// Draws heads, any number of them one after the other, each where SetViewport says: so one window
/// shows several faces. Programs and targets are shared by all of them; of the heads drawn last it
/// keeps what never changes. Owns its GL objects; the context outlives it and is current in every
/// call. 4x antialiased. The same head, state, scene and size give the same picture, whatever was
/// drawn before.
class Renderer {
 public:
  /// `heads`: how many are kept at most, 1 or more, each with some 20 MB of textures; one more
  /// takes the place of the one that was not drawn for longest.
  static std::unique_ptr<Renderer> Make(RenderContext& context, std::size_t heads = 8);
  /// `appearance` in place of the built-in one; it outlives the renderer. Throws std::runtime_error
  /// if `rig` is kCard and the driver cannot do it.
  static std::unique_ptr<Renderer> Make(RenderContext& context, std::size_t heads,
                                        const Appearance& appearance, RigOn rig = RigOn::kBest);
  virtual ~Renderer() = default;
  /// Where the next frames go; at first everywhere.
  virtual void SetViewport(const Viewport& viewport) = 0;
  /// By how many pixels a face may be off at most, so that small ones are drawn with fewer
  /// triangles (CoarseTriangles); at first 0: all are drawn, which pictures to be measured need.
  virtual void SetFormError(float pixels) = 0;
  /// `vertices` belong to `head` (Evaluate of `state`).
  virtual void Draw(const Head& head, const HeadVertices& vertices, const FaceState& state,
                    const Scene& scene) = 0;
  /// The same of the vertices that the head's rig makes of `state` and `swings` (Rig::Evaluate),
  /// which a card makes itself (GpuRig), and within what GpuRig says they are the same.
  virtual void Draw(const Head& head, const FaceState& state, std::span<const glm::vec3> swings,
                    const Scene& scene) = 0;
  /// The frame drawn last, of the viewport's size.
  virtual void Read(Image& out) = 0;
  /// Begins to bring the frame drawn last to memory while others are drawn, which a graphics card
  /// does by itself; each frame under way holds 16 bytes a pixel there. Two or three keep it busy.
  /// Returns what EndRead and DropRead know the frame by.
  virtual std::uint64_t BeginRead() = 0;
  /// The same bytes as Read; waits until they are there. Frames may end in any order.
  virtual void EndRead(std::uint64_t frame, Image& out) = 0;
  virtual void DropRead(std::uint64_t frame) = 0;
};

}  // namespace fsm
