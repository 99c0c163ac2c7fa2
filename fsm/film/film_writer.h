#pragma once

#include <memory>
#include <string>

#include "fsm/image/image.h"
#include "vm_protocol/core/result.h"

namespace fsm {

/// Writes a film through an ffmpeg process fed with raw frames; .rgba is written without one.
/// Lifetime: Finish() or the destructor ends the process; without Finish the file is removed.
/// Deterministic: the same frames give the same bytes (no time stamps, one encoder thread).
class FilmWriter {
 public:
  /// .mp4 (H.264, yuv420p); .mov (ProRes 4444) or .webm (VP9), which keep what is transparent; .mkv
  /// (FFV1 in RGB, FLAC), which keeps colours and sound to the bit; or .rgba: every frame's width *
  /// height * 4 bytes one after the other, into a file or a named pipe that somebody reads (SIGPIPE
  /// must be ignored). Error: kUnavailable if ffmpeg is missing or refuses, with its last line. 1
  /// to 1000 frames per second; `comment`: told to whoever reads the file's metadata, unless it is
  /// .rgba.
  static vm::Result<std::unique_ptr<FilmWriter>> Open(const std::string& path, int width,
                                                      int height, double frames_per_second,
                                                      const std::string& comment = {});
  /// Whether the name ends as one of these. Error: kBadValue, as of Open.
  static vm::Result<void> CheckName(const std::string& path);
  virtual ~FilmWriter() = default;
  /// The size must be that given at Open. Handed on by another thread; blocks only while several
  /// frames wait. An error may belong to a frame before.
  virtual vm::Result<void> Add(const Image& frame) = 0;
  /// Ends the film; `sound_wav` (may be empty) is added as its sound from the start. The result is
  /// moved to the path only when complete. Errors: kUnavailable; when only the sound is at fault
  /// the silent film is at the path and the text says so. Takes as long as the encoder needs.
  virtual vm::Result<void> Finish(const std::string& sound_wav) = 0;
  /// Whether somebody watches the frames as they come, so that none should wait for later ones.
  virtual bool is_live() const { return false; }
};

}  // namespace fsm
