#pragma once

#include <sys/types.h>

#include <atomic>
#include <deque>
#include <vector>

#include "face_track/film/picture_source.h"

namespace facetrack {

/// What ffmpeg decodes: pictures from its standard output, their times and its complaints from its
/// standard error. Upright, with square pixels, at most `most_side` on a side. One picture is held
/// at a time. The destructor ends the process.
class FfmpegSource final : public PictureSource {
 public:
  /// `input`: words of its command line up to "-i" and what follows it. No shell is involved.
  /// `stdin_file`: what ffmpeg has as its standard input; empty: this program's.
  static vm::Result<std::unique_ptr<PictureSource>> Open(
      const std::string& name, const std::vector<std::string>& input, int most_side,
      const std::string& stdin_file = "/dev/null");
  /// A film that names no other file: formats that do, as playlists, are refused. "-": the
  /// program's standard input. Errors: also those of vm::CheckReadable.
  static vm::Result<std::unique_ptr<PictureSource>> OpenFilm(const std::string& name,
                                                             int most_side);
  ~FfmpegSource() override;
  vm::Result<bool> Next(TimedPicture& out) override;
  std::optional<double> length_ms() const override { return length_ms_; }
  void Stop() override { stopped_ = true; }

 private:
  FfmpegSource(std::string name, int most_side, pid_t pid, int output, int errors)
      : name_(std::move(name)),
        most_side_(most_side),
        pid_(pid),
        output_(output),
        errors_(errors) {}
  /// Waits for either end and takes what there is; false at the time limit.
  bool Pump(std::vector<std::uint8_t>* into, std::size_t& have);
  void TakeErrors();
  void TakeLine(const std::string& line);
  std::unexpected<vm::Error> Failed(vm::Errc code, const std::string& what);

  const std::string name_;
  const int most_side_;
  pid_t pid_;
  int output_, errors_;  // our ends of pipes; -1 at their end
  std::atomic<bool> stopped_ = false;
  std::string line_, complaint_;
  std::deque<double> times_ms_;  // of pictures to come
  int width_ = 0, height_ = 0;
  std::optional<double> length_ms_;
  std::optional<double> first_ms_;
  std::size_t pictures_ = 0;
};

}  // namespace facetrack
