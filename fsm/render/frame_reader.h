#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "fsm/image/image.h"
#include "fsm/render/gl_objects.h"

namespace fsm {

/// How a frame is read.
struct ReadOptions {
  Filter filter = Filter::kBox;
  bool transparent = false;  ///< its colours are premultiplied: Unmultiply follows
};

/// Reads frames back to memory while others are drawn. Destroy while its context is current.
class FrameReader {
 public:
  /// `on_gpu`: the GPU averages each frame asynchronously into a buffer that is read on demand. A
  /// software driver cannot do that in parallel, so frames are then read in Begin. REQUIRES for
  /// `on_gpu`: GlFunctions::has_compute.
  FrameReader(const GlFunctions& gl, bool on_gpu);
  ~FrameReader();
  FrameReader(const FrameReader&) = delete;
  FrameReader& operator=(const FrameReader&) = delete;

  /// Returns the handle of the frame for End and Drop; the framebuffer may be drawn into again.
  std::uint64_t Begin(GlFramebuffer& framebuffer, const ReadOptions& options);
  /// Waits for this frame only, not for later ones; the bytes are those of GlFramebuffer::Read.
  /// Frames may end in any order. Throws std::runtime_error if the driver does not return the data.
  void End(std::uint64_t frame, Image& out);
  void Drop(std::uint64_t frame);

 private:
  struct Buffer {
    GLuint name = 0;
    GLsizeiptr bytes = 0;
  };
  struct Frame {
    Image image;    ///< the picture read, or its size only
    Buffer buffer;  ///< name 0: the frame was read in Begin
    bool transparent = false;
  };

  void BeginAverage(const GlFramebuffer& framebuffer, Filter filter, Frame& frame);
  void EndAverage(const Frame& frame, Image& out);

  const GlFunctions& gl_;
  std::optional<GlProgram> average_;  // on a GPU only
  std::map<std::uint64_t, Frame> frames_;
  std::uint64_t last_ = 0;
  std::vector<Buffer> spare_buffers_;
};

}  // namespace fsm
