#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <memory>
#include <span>

#include "fsm/image/image.h"
#include "fsm/render/pane.h"
#include "fsm/render/render_context.h"
#include "fsm/rig/face_state.h"
#include "fsm/rig/head.h"

namespace fsm {

class Appearance;

/// The device that moves the vertices of a head that is drawn from its state.
enum class RigDevice {
  kBest,  ///< the GPU if one draws and has compute shaders (OpenGL 4.3)
  kProcessor,
  kGpu  ///< even if the "GPU" is a software driver
};

/// Draws any number of heads one after the other, each in the current viewport, so that one window
/// can show several faces. All heads share programs and framebuffers; the constant data of the
/// heads drawn last is kept. Owns its GL objects; the context must outlive it and be current in
/// every call. Antialiased with 4 samples. The same head, state, scene and size give the same
/// picture, whatever was drawn before.
class Renderer {
 public:
  /// `heads`: number of heads kept, at least 1, each with about 20 MB of textures; the next head
  /// replaces the one that has not been drawn for the longest time.
  static std::unique_ptr<Renderer> Make(RenderContext& context, std::size_t heads = 8);
  /// `appearance` replaces the built-in one and must outlive the renderer. Throws
  /// std::runtime_error if `rig` is kGpu and the driver cannot do it.
  static std::unique_ptr<Renderer> Make(RenderContext& context, std::size_t heads,
                                        const Appearance& appearance,
                                        RigDevice rig = RigDevice::kBest);
  virtual ~Renderer() = default;
  /// Sets where the next frames are drawn; initially everywhere.
  virtual void SetViewport(const Viewport& viewport) = 0;
  /// Sets by how many pixels a face may be off, so that small ones are drawn with fewer triangles
  /// (CoarseTriangles). Initially 0: all triangles, as measurements on pictures need.
  virtual void SetMaxErrorPixels(float pixels) = 0;
  /// REQUIRES: `vertices` belong to `head`.
  virtual void DrawVertices(const Head& head, const HeadVertices& vertices, const Figure& figure,
                            const Scene& scene) = 0;
  /// Draws the vertices that the head's rig computes from `state` and `spring_offsets`
  /// (Rig::Evaluate). A GPU computes them itself (GpuRig), with the accuracy stated there.
  virtual void Draw(const Head& head, const FaceState& state,
                    std::span<const glm::vec3> spring_offsets, const Scene& scene) = 0;
  /// Draws each pane in its viewport and then calls `drawn` with its index, which may read the
  /// frame but not draw. A GPU moves consecutive faces of one head in one call. Afterwards the
  /// viewport is the previous one again.
  virtual void DrawPanes(std::span<const Pane> panes,
                         const std::function<void(std::size_t)>& drawn = {}) = 0;
  /// Reads the last frame drawn, of the viewport's size.
  virtual void Read(Image& out) = 0;
  /// Starts reading the last frame drawn; a GPU does so while others are drawn. Each
  /// pending frame holds 16 bytes per pixel on the GPU; two or three keep it busy. Returns the
  /// handle for EndRead and DropRead.
  virtual std::uint64_t BeginRead() = 0;
  /// Waits for the frame and returns the bytes of Read. Frames may end in any order.
  virtual void EndRead(std::uint64_t frame, Image& out) = 0;
  virtual void DropRead(std::uint64_t frame) = 0;
};

}  // namespace fsm
