#include "face_track/film/ffmpeg_source.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <system_error>
#include <utility>

#include "vm_protocol/core/file_kind.h"
#include "vm_protocol/core/spawn.h"

namespace facetrack {
namespace {

constexpr std::size_t kMaxLine = 2000;
constexpr const char* kOnStdin = "file:/dev/fd/0";  // unlike a pipe it can be sought in
constexpr std::size_t kMostTimes = 100'000;  // told before their pictures: ffmpeg's queues hold few

std::unexpected<vm::Error> CannotStart(int error) {
  std::string text = "cannot start ffmpeg: " + std::generic_category().message(error);
  if (error == ENOENT) text += " (ffmpeg must be installed and found along PATH)";
  return vm::Fail(vm::Errc::kUnavailable, std::move(text));
}

/// The number after `key` in a line.
std::optional<double> After(const std::string& line, std::string_view key) {
  const auto at = line.find(key);
  if (at == std::string::npos) return std::nullopt;
  char* end = nullptr;
  const char* begin = line.c_str() + at + key.size();
  const double value = std::strtod(begin, &end);
  if (end == begin) return std::nullopt;
  return value;
}

}  // namespace

vm::Result<std::unique_ptr<PictureSource>> FfmpegSource::OpenFilm(const std::string& name,
                                                                  int most_side) {
  // ffmpeg's names of formats that hold all they show.
  constexpr const char* kFormats =
      "mov,matroska,avi,mpegts,mpeg,mpegvideo,ogg,flv,asf,mxf,nut,ivf,wtv,rm,dv,gif,apng,mjpeg,"
      "h264,hevc,m4v,yuv4mpegpipe,png_pipe,jpeg_pipe,bmp_pipe,webp_pipe,wav,mp3,flac,aac";
  std::vector<std::string> words{"-format_whitelist", kFormats, "-protocol_whitelist", "file,pipe",
                                 "-i"};
  if (name == "-") {
    words.emplace_back("pipe:0");
    return Open(name, words, most_side, "");
  }
  if (auto fit = vm::CheckReadable(name); !fit) return std::unexpected(fit.error());
  // ffmpeg is not told the name, which could mean more to it than a file.
  words.emplace_back(kOnStdin);
  return Open(name, words, most_side, name);
}

vm::Result<std::unique_ptr<PictureSource>> FfmpegSource::Open(const std::string& name,
                                                              const std::vector<std::string>& input,
                                                              int most_side,
                                                              const std::string& stdin_file) {
  std::vector<std::string> words{"ffmpeg", "-hide_banner", "-nostats", "-loglevel", "level+info"};
  if (!stdin_file.empty()) words.push_back("-nostdin");
  words.insert(words.end(), input.begin(), input.end());
  const std::string filters = fmt::format(
      "scale=w='trunc(iw*sar)':h=ih,setsar=1,"
      "scale=w='min({0},iw)':h='min({0},ih)':force_original_aspect_ratio=decrease,showinfo",
      most_side);
  for (const char* word : {"-map", "0:v:0", "-vf", filters.c_str(), "-fps_mode", "passthrough",
                           "-pix_fmt", "rgba", "-f", "rawvideo", "pipe:1"}) {
    words.emplace_back(word);
  }
  int output[2], errors[2];
  if (pipe2(output, O_CLOEXEC) != 0) return CannotStart(errno);
  if (pipe2(errors, O_CLOEXEC) != 0) {
    const int error = errno;
    close(output[0]);
    close(output[1]);
    return CannotStart(error);
  }
  vm::Spawn spawn;
  if (!stdin_file.empty()) spawn.Open(stdin_file, O_RDONLY, STDIN_FILENO);
  spawn.Give(output[1], STDOUT_FILENO);
  spawn.Give(errors[1], STDERR_FILENO);
  pid_t pid = 0;
  const int error = spawn.Start(words, pid);
  close(output[1]);
  close(errors[1]);
  if (error != 0) {
    close(output[0]);
    close(errors[0]);
    return CannotStart(error);
  }
  fcntl(output[0], F_SETFL, O_NONBLOCK);
  fcntl(errors[0], F_SETFL, O_NONBLOCK);
  return std::unique_ptr<PictureSource>(
      new FfmpegSource(name, most_side, pid, output[0], errors[0]));
}

FfmpegSource::~FfmpegSource() {
  for (const int fd : {output_, errors_}) {
    if (fd >= 0) close(fd);
  }
  kill(pid_, SIGKILL);
  while (waitpid(pid_, nullptr, 0) < 0 && errno == EINTR) {
  }
}

void FfmpegSource::TakeLine(const std::string& line) {
  // What a film says of itself stands in other lines.
  if (line.starts_with("[Parsed_showinfo_")) {
    const auto seconds = After(line, "pts_time:");
    const auto size = line.find(" s:");
    if (size == std::string::npos) return;
    // A picture without a time follows the one before it.
    const double last = times_ms_.empty() ? first_ms_.value_or(0) : times_ms_.back();
    if (times_ms_.size() < kMostTimes) times_ms_.push_back(seconds ? 1000 * *seconds : last);
    int width = 0, height = 0;
    if (width_ == 0 && std::sscanf(line.c_str() + size, " s:%dx%d", &width, &height) == 2) {
      width_ = width;
      height_ = height;
    }
    return;
  }
  if (int h = 0, m = 0; const auto at = line.find("Duration: ")) {
    double s = 0;
    if (at != std::string::npos &&
        std::sscanf(line.c_str() + at, "Duration: %d:%d:%lf", &h, &m, &s) == 3) {
      length_ms_ = 1000 * (3600.0 * h + 60.0 * m + s);
    }
  }
  for (const std::string_view level : {"[error] ", "[fatal] ", "[panic] "}) {
    const auto at = line.find(level);
    if (at == std::string::npos) continue;
    complaint_ = line.substr(at + level.size());
    const std::string file = std::string(kOnStdin) + ": ";
    if (complaint_.starts_with(file)) complaint_.erase(0, file.size());
  }
}

void FfmpegSource::TakeErrors() {
  char block[4096];
  const auto got = read(errors_, block, sizeof block);
  if (got == 0) close(std::exchange(errors_, -1));
  for (ssize_t i = 0; i < got; ++i) {
    if (block[i] != '\n' && block[i] != '\r') {
      if (line_.size() < kMaxLine) line_ += block[i];
    } else if (!line_.empty()) {
      TakeLine(std::exchange(line_, {}));
    }
  }
}

bool FfmpegSource::Pump(std::vector<std::uint8_t>* into, std::size_t& have) {
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(kStallSeconds);
  while (std::chrono::steady_clock::now() < deadline && !stopped_) {
    pollfd wanted[2] = {{errors_, POLLIN, 0}, {into ? output_ : -1, POLLIN, 0}};
    if (poll(wanted, 2, 100) <= 0) continue;
    if (wanted[0].revents != 0) TakeErrors();
    if (wanted[1].revents != 0) {
      const auto got = read(output_, into->data() + have, into->size() - have);
      if (got > 0) have += static_cast<std::size_t>(got);
      if (got == 0) close(std::exchange(output_, -1));
    }
    return true;
  }
  return false;
}

std::unexpected<vm::Error> FfmpegSource::Failed(vm::Errc code, const std::string& what) {
  return vm::Fail(code, "'" + name_ + "' " + what +
                            (complaint_.empty() ? "" : " (ffmpeg: " + complaint_ + ")"));
}

vm::Result<bool> FfmpegSource::Next(TimedPicture& out) {
  std::size_t have = 0;
  const auto stalled = [&]() -> vm::Result<bool> {
    if (stopped_) return false;
    return Failed(vm::Errc::kTimeout,
                  fmt::format("has given no picture for {} seconds", kStallSeconds));
  };
  // A picture is told of before it comes.
  while (times_ms_.empty() && errors_ >= 0) {
    if (!Pump(nullptr, have)) return stalled();
  }
  if (times_ms_.empty()) {
    siginfo_t end{};
    const bool failed = waitid(P_PID, static_cast<id_t>(pid_), &end, WEXITED | WNOWAIT) == 0 &&
                        (end.si_code != CLD_EXITED || end.si_status != 0);
    if (pictures_ == 0) return Failed(vm::Errc::kBadValue, "is no film with a picture");
    if (failed)
      return Failed(vm::Errc::kUnavailable,
                    fmt::format("ended early, after {} pictures", pictures_));
    return false;
  }
  if (width_ < 16 || height_ < 16) return Failed(vm::Errc::kBadValue, "is smaller than 16 x 16");
  if (width_ > most_side_ || height_ > most_side_) {
    return Failed(vm::Errc::kBadValue, fmt::format("is larger than {0} x {0}", most_side_));
  }
  out.picture.width = width_;
  out.picture.height = height_;
  out.picture.rgba.resize(4 * static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_));
  while (have < out.picture.rgba.size()) {
    if (output_ < 0) {
      return Failed(vm::Errc::kUnavailable, fmt::format("ends within picture {}", pictures_));
    }
    if (!Pump(&out.picture.rgba, have)) return stalled();
  }
  out.ms = times_ms_.front();
  times_ms_.pop_front();
  if (!first_ms_) first_ms_ = out.ms;
  out.ms -= *first_ms_;
  ++pictures_;
  return true;
}

}  // namespace facetrack
