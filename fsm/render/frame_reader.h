#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "fsm/image/image.h"
#include "fsm/render/gl_objects.h"

namespace fsm {

/// Brings frames to memory while others are drawn. Destroy while its context is current.
class FrameReader {
 public:
  /// `on_card`: a card averages each frame, in its own time, into a buffer that is read when it is
  /// wanted. A software driver has nobody to do that, so there frames are read when they begin.
  /// REQUIRES of `on_card`: GlFunctions::has_compute.
  FrameReader(const GlFunctions& gl, bool on_card);
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
  struct Buffer {
    GLuint name = 0;
    GLsizeiptr bytes = 0;
  };
  struct Frame {
    Image image;    ///< what was read, or as large as it will be
    Buffer buffer;  ///< name 0: it was read
    bool transparent = false;
  };

  void BeginAverage(const GlTarget& target, bool soft, Frame& frame);
  void EndAverage(const Frame& frame, Image& out);

  const GlFunctions& gl_;
  std::optional<GlProgram> average_;  // on a card
  std::map<std::uint64_t, Frame> frames_;
  std::uint64_t last_ = 0;
  std::vector<Buffer> spare_buffers_;
};

}  // namespace fsm
