#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <vector>

#include "fsm/image/image.h"
#include "fsm/render/gl_objects.h"

namespace fsm {

/// Brings frames to memory while others are drawn. Destroy while its context is current.
class FrameReader {
 public:
  /// Frames that wait where they were drawn, at most.
  static constexpr std::size_t kMostWaiting = 4;

  /// `by_buffers`: each frame goes through a pixel pack buffer, which a graphics card fills in its
  /// own time. A software driver has nobody to do that: it would copy at once, and once more than
  /// needed. It also waits for all that is drawn before it hands out anything, so there small
  /// frames wait where they were drawn, up to kMostWaiting, and are read together; so its threads
  /// draw one face while the next is prepared. Others are read when they begin.
  FrameReader(const GlFunctions& gl, bool by_buffers) : gl_(gl), by_buffers_(by_buffers) {}
  ~FrameReader();
  FrameReader(const FrameReader&) = delete;
  FrameReader& operator=(const FrameReader&) = delete;

  /// `soft`: as of AverageSamples; `transparent`: Unmultiply follows. Returns what End and Drop
  /// know the frame by. The target may be drawn into again unless somebody else still holds it;
  /// `small`: it may be kept until others are drawn.
  std::uint64_t Begin(const std::shared_ptr<GlTarget>& target, bool soft, bool transparent,
                      bool small);
  /// Waits for the frame, and on a graphics card for nothing drawn after it. The same bytes as
  /// GlTarget::Read. Frames may end in any order. Throws std::runtime_error if the driver does not
  /// hand it out.
  void End(std::uint64_t frame, Image& out);
  void Drop(std::uint64_t frame);

 private:
  struct Frame {
    Image image;                       ///< what was read, or as large as it will be
    GLuint buffer = 0;                 ///< where a graphics card copies it
    std::shared_ptr<GlTarget> target;  ///< where it waits
    bool soft = false, transparent = false;
  };

  void BeginCopy(const GlTarget& target, Frame& frame);
  void EndCopy(Frame& frame);
  void ReadWaiting();

  const GlFunctions& gl_;
  const bool by_buffers_;
  std::map<std::uint64_t, Frame> frames_;
  std::uint64_t last_ = 0;
  std::vector<GLuint> spare_buffers_;
};

}  // namespace fsm
