#include "fsm/film/film_kind.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>

namespace fsm {
namespace {

/// Returns a path as a URL, so that ffmpeg cannot read it as an option or as another protocol.
std::string FileUrl(const std::string& path) { return "file:" + path; }

void Append(FfmpegArguments& arguments, std::initializer_list<std::string> more) {
  arguments.insert(arguments.end(), more);
}

/// Returns the first arguments: no banner, no questions, only errors.
FfmpegArguments CommonArguments() {
  return {"-hide_banner", "-nostdin", "-loglevel", "error", "-y"};
}

void AppendOutput(FfmpegArguments& arguments, const FilmKind& kind, const std::string& comment,
                  const std::string& path) {
  Append(arguments, {"-map_metadata", "-1", "-fflags", "+bitexact"});
  if (!comment.empty()) Append(arguments, {"-metadata", "comment=" + comment});
  if (kind.ending == ".mp4" || kind.ending == ".mov")
    Append(arguments, {"-movflags", "+faststart"});
  Append(arguments, {"-f", kind.muxer, FileUrl(path)});
}

}  // namespace

const FilmKind* FilmKindOf(std::string_view path) {
  static const std::vector<FilmKind> kinds = {
      {".mp4",
       false,
       "mp4",
       "yuv420p",
       {"libx264", "-preset", "superfast", "-crf", "18"},
       {"aac", "-b:a", "160k"}},
      {".mov", true, "mov", "yuva444p10le", {"prores_ks", "-profile:v", "4444"}, {"pcm_s16le"}},
      // The encoder does not support alternate reference frames with transparency.
      {".webm",
       true,
       "webm",
       "yuva420p",
       {"libvpx-vp9", "-deadline", "realtime", "-cpu-used", "6", "-crf", "20", "-b:v", "0",
        "-auto-alt-ref", "0"},
       {"libopus", "-b:a", "96k"}},
      {".mkv", true, "matroska", "bgr0", {"ffv1", "-level", "3", "-slicecrc", "1"}, {"flac"}, true},
  };
  const auto found = std::ranges::find_if(kinds, [path](const FilmKind& kind) {
    return path.size() > kind.ending.size() && path.ends_with(kind.ending);
  });
  return found == kinds.end() ? nullptr : &*found;
}

std::string SizeText(int width, int height) {
  return std::to_string(width) + "x" + std::to_string(height);
}

FfmpegArguments EncodeArguments(const FilmKind& kind, int width, int height,
                                double frames_per_second, const std::string& comment,
                                const std::string& path) {
  FfmpegArguments arguments = CommonArguments();
  Append(arguments, {"-f", "rawvideo", "-pixel_format", kind.as_rgba ? "rgba" : "yuv420p"});
  // Sides are made even by YuvPlanes, or by ffmpeg for RGBA.
  Append(arguments,
         {"-video_size", kind.as_rgba ? SizeText(width, height)
                                      : SizeText(width + width % 2, height + height % 2)});
  Append(arguments,
         {"-framerate", fmt::format("{:.10g}", frames_per_second), "-i", "pipe:0", "-an"});
  if (kind.as_rgba && !kind.is_rgb) {
    Append(arguments, {"-vf",
                       "pad=ceil(iw/2)*2:ceil(ih/2)*2:color=black@0,"
                       "scale=out_color_matrix=bt709:out_range=tv,format=" +
                           std::string(kind.pixels)});
  }
  if (!kind.is_rgb) {
    // Name the BT.709 matrix, primaries and transfer in the file: without them players guess
    // differently, and skin turns orange or green.
    Append(arguments, {"-colorspace", "bt709", "-color_primaries", "bt709", "-color_trc", "bt709",
                       "-color_range", "tv"});
  }
  Append(arguments, {"-c:v"});
  arguments.insert(arguments.end(), kind.encoder.begin(), kind.encoder.end());
  Append(arguments, {"-pix_fmt", kind.pixels, "-g",
                     std::to_string(kind.is_rgb ? 1 : std::lround(frames_per_second * 2)),
                     "-threads", "1", "-flags:v", "+bitexact"});
  AppendOutput(arguments, kind, comment, path);
  return arguments;
}

FfmpegArguments SoundArguments(const FilmKind& kind, const std::string& film,
                               const std::string& sound, const std::string& comment,
                               const std::string& path) {
  FfmpegArguments arguments = CommonArguments();
  Append(arguments, {"-i", FileUrl(film), "-i", FileUrl(sound), "-map", "0:v:0", "-map", "1:a:0",
                     "-c:v", "copy", "-c:a"});
  arguments.insert(arguments.end(), kind.sound.begin(), kind.sound.end());
  Append(arguments, {"-threads", "1", "-flags:a", "+bitexact"});
  AppendOutput(arguments, kind, comment, path);
  return arguments;
}

}  // namespace fsm
