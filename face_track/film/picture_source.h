#pragma once

#include <memory>
#include <optional>
#include <string>

#include "fsm/image/image.h"
#include "vm_protocol/core/result.h"

namespace facetrack {

/// A picture of a film and when it is shown.
struct TimedPicture {
  fsm::Image picture;
  double ms = 0;
};

/// Pictures, one after the other. Thread: one, but Stop.
class PictureSource {
 public:
  virtual ~PictureSource() = default;
  /// The next one into `out`, whose memory is used again; false at the end. Errors: kUnavailable
  /// (cannot be read, ends in the middle), kBadValue (is no film, has no picture).
  virtual vm::Result<bool> Next(TimedPicture& out) = 0;
  /// How many there are, as far as that is known; for telling how far one is.
  virtual std::optional<double> length_ms() const { return std::nullopt; }
  /// Makes a Next that waits end soon. Thread: any.
  virtual void Stop() {}
};

/// The longest side of what films are read at: more shows the network nothing more.
inline constexpr int kMostSide = 1280;
/// The same for what is to be written again.
inline constexpr int kWholeSide = 4096;
/// A source that gives no picture for so long has failed.
inline constexpr int kStallSeconds = 30;

/// By name:
///   FILE             any film ffmpeg reads
///   -                the same from standard input
///   FOLDER           its .png, .jpg and .jpeg, by name, `rate` a second
///   camera           the first camera, /dev/video0
///   v4l2:DEVICE      another one
///   ffmpeg:WORDS     any input of ffmpeg, as its command line has it: ffmpeg:-f lavfi -i testsrc;
///                    only options of inputs, since other words could make it write files
/// Larger ones are made smaller, to `most_side`. Errors: kUnavailable, kBadValue.
vm::Result<std::unique_ptr<PictureSource>> OpenPictures(const std::string& name, double rate,
                                                        int most_side = kMostSide);
/// Whether a source of that name goes on by itself, at its own pace.
bool IsLive(const std::string& name);

}  // namespace facetrack
