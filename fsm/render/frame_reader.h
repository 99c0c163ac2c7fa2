#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "fsm/image/image.h"
#include "fsm/render/gl_objects.h"

namespace fsm {

/// Brings frames to memory while others are drawn. Destroy while its context is current.
class FrameReader {
 public:
  /// `by_buffers`: each frame goes through a pixel pack buffer, which a graphics card fills in its
  /// own time. A software driver has nobody to do that: it would copy at once, and once more than
  /// needed, so there frames are read when they begin.
  FrameReader(const GlFunctions& gl, bool by_buffers) : gl_(gl), by_buffers_(by_buffers) {}
  ~FrameReader();
  FrameReader(const FrameReader&) = delete;
  FrameReader& operator=(const FrameReader&) = delete;

  /// `soft`: as of AverageSamples; `transparent`: Unmultiply follows. Returns what End and Drop
  /// know the frame by; the target may be drawn into again.
  std::uint64_t Begin(GlTarget& target, bool soft, bool transparent);
  /// Waits for the frame and for nothing drawn after it. The same bytes as GlTarget::Read. Frames
  /// may end in any order. Throws std::runtime_error if the driver does not hand it out.
  void End(std::uint64_t frame, Image& out);
  void Drop(std::uint64_t frame);

 private:
  struct Frame {
    Image image;        ///< what was read, or as large as it will be
    GLuint buffer = 0;  ///< 0: it is read
    bool soft = false, transparent = false;
  };

  void BeginCopy(const GlTarget& target, Frame& frame);
  void EndCopy(Frame& frame);

  const GlFunctions& gl_;
  const bool by_buffers_;
  std::map<std::uint64_t, Frame> frames_;
  std::uint64_t last_ = 0;
  std::vector<GLuint> spare_buffers_;
};

}  // namespace fsm
