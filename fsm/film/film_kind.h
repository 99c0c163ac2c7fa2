#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace fsm {

/// Arguments of ffmpeg, without the program's name.
using FfmpegArguments = std::vector<std::string>;

/// A kind of film, selected by the ending of its name.
struct FilmKind {
  std::string_view ending;
  bool as_rgba;  ///< frames are passed to ffmpeg as RGBA, not as YuvPlanes
  const char* muxer;
  const char* pixels;              ///< ffmpeg's name of the pixel format
  FfmpegArguments encoder, sound;  ///< arguments of the video and audio encoders
  bool is_rgb = false;             ///< the film stores RGB, without loss
};
/// Returns the kind of a film's name; null if there is none. Valid until the end of the program.
const FilmKind* FilmKindOf(std::string_view path);

/// Returns the arguments that encode raw frames from standard input as the film `path`. `comment`
/// is written into its metadata; "" = none.
FfmpegArguments EncodeArguments(const FilmKind& kind, int width, int height,
                                double frames_per_second, const std::string& comment,
                                const std::string& path);
/// Returns the arguments that write the film `path` from the pictures of `film` and a sound file.
FfmpegArguments SoundArguments(const FilmKind& kind, const std::string& film,
                               const std::string& sound, const std::string& comment,
                               const std::string& path);

/// Returns "640x480".
std::string SizeText(int width, int height);

}  // namespace fsm
