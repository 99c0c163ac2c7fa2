#pragma once

#include <memory>
#include <string>

#include "fsm/image/image.h"
#include "vm_protocol/core/result.h"

namespace fsm {

/// Writes a film through an ffmpeg process that receives raw frames; .rgba is written without one.
/// Lifetime: Finish() or the destructor ends the process. Without Finish no file is left at
///           the path, except for .rgba, whose frames are written to it at once.
/// Deterministic: the same frames give the same bytes (no time stamps, one encoder thread).
class FilmWriter {
 public:
  /// Opens a film for writing. The ending of `path` chooses its kind:
  ///   .mp4         H.264, yuv420p
  ///   .mov, .webm  ProRes 4444, VP9: keep transparency
  ///   .mkv         FFV1 in RGB, FLAC: keeps colours and sound to the bit
  ///   .rgba        width * height * 4 bytes for each frame, into a file or a named pipe that
  ///                somebody reads. REQUIRES: SIGPIPE is ignored.
  /// `frames_per_second`: 1..1000. `comment` is written into the film's metadata; .rgba has none.
  /// Errors: kBadValue for a name, size or rate that is not allowed; kUnavailable if `path` cannot
  /// be written, nobody reads the pipe, or ffmpeg is missing or refuses (with its last line).
  static vm::Result<std::unique_ptr<FilmWriter>> Open(const std::string& path, int width,
                                                      int height, double frames_per_second,
                                                      const std::string& comment = {});
  /// Checks that the path has one of these endings. Error: kBadValue, as of Open.
  static vm::Result<void> CheckName(const std::string& path);
  virtual ~FilmWriter() = default;
  /// Adds a frame. Another thread passes it to ffmpeg: the call blocks only while
  /// FrameFeeder::kMaxWaiting frames wait, and an error may be that of an earlier frame. An .rgba
  /// frame is written by the caller's thread: the call blocks until the file or the reader of the
  /// pipe has taken all of it. A reader that takes nothing for five seconds is an error. Errors:
  /// kBadValue for a frame of another size than that given at Open, which is left out;
  /// kUnavailable, and the film has then ended.
  virtual vm::Result<void> Add(const Image& frame) = 0;
  /// Ends the film; `sound_wav` (may be empty) is added as its sound from the start. The result is
  /// moved to the path only when complete. Errors: kUnavailable; when only the sound is at fault
  /// the silent film is at the path and the text says so. Takes as long as the encoder needs.
  virtual vm::Result<void> Finish(const std::string& sound_wav) = 0;
  /// Tells whether frames are consumed as they arrive, so that none should be delayed until later
  /// ones.
  virtual bool is_live() const { return false; }
};

}  // namespace fsm
