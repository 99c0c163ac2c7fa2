#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <memory>
#include <span>

#include "fsm/image/image.h"
#include "fsm/render/render_context.h"
#include "fsm/render/scene.h"
#include "fsm/rig/face_state.h"
#include "fsm/rig/head.h"

namespace fsm {

class Appearance;

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
  /// Draws the vertices that the head's rig makes of `state` and `swings` (Rig::Evaluate). A card
  /// makes them itself (GpuRig), equal within what GpuRig says.
  virtual void Draw(const Head& head, const FaceState& state, std::span<const glm::vec3> swings,
                    const Scene& scene) = 0;
  /// One face of many, borrowed for the call.
  struct Pane {
    const Head* head;
    const FaceState* state;
    const Scene* scene;
    Viewport viewport = {};
    std::span<const glm::vec3> swings = {};
  };
  /// Draws each in its viewport as above, and calls `drawn`, which may read but not draw, with its
  /// number when it is the frame drawn last. A card moves faces of one head that follow each other
  /// in one go. The viewport is afterwards what it was.
  virtual void Draw(std::span<const Pane> panes,
                    const std::function<void(std::size_t)>& drawn = {}) = 0;
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
