#include "fsm/film/film_writer.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cassert>
#include <cerrno>
#include <optional>
#include <span>
#include <system_error>
#include <utility>

#include "fsm/film/ffmpeg_process.h"
#include "fsm/film/film_kind.h"
#include "fsm/film/frame_feeder.h"
#include "fsm/film/yuv_planes.h"
#include "vm_protocol/core/file_kind.h"
#include "vm_protocol/core/text_file.h"

namespace fsm {
namespace {

constexpr int kMaxFramesPerSecond = 1000;

bool IsRaw(std::string_view path) {
  constexpr std::string_view kRaw = ".rgba";
  return path.size() > kRaw.size() && path.ends_with(kRaw);
}

vm::Result<void> CheckFrame(const Image& frame, int width, int height, const std::string& path) {
  assert(frame.IsWhole());
  if (frame.width == width && frame.height == height) return {};
  return vm::Fail(vm::Errc::kBadValue, "a frame of " + SizeText(frame.width, frame.height) +
                                           " does not fit into the film '" + path + "' of " +
                                           SizeText(width, height));
}

class FfmpegFilmWriter : public FilmWriter {
 public:
  FfmpegFilmWriter(const FilmKind& kind, std::string comment, std::string path, vm::DraftFile draft,
                   int width, int height, std::unique_ptr<FfmpegProcess> ffmpeg)
      : kind_(kind),
        comment_(std::move(comment)),
        path_(std::move(path)),
        draft_(std::move(draft)),
        width_(width),
        height_(height),
        ffmpeg_(std::move(ffmpeg)) {
    feeder_.emplace(*ffmpeg_);
  }

  ~FfmpegFilmWriter() override {
    feeder_.reset();
    ffmpeg_.reset();
  }

  vm::Result<void> Add(const Image& frame) override {
    if (auto fits = CheckFrame(frame, width_, height_, path_); !fits) return fits;
    if (!ffmpeg_) return vm::Fail(vm::Errc::kUnavailable, "the film '" + path_ + "' has ended");
    auto bytes = feeder_->TakeSpare();
    if (kind_.as_rgba) {
      bytes.assign(frame.rgba.begin(), frame.rgba.end());
    } else {
      YuvPlanes(frame, bytes);
    }
    if (auto added = feeder_->Add(std::move(bytes)); !added) {
      return Fail(std::move(added.error()));
    }
    ++frames_;
    return {};
  }

  vm::Result<void> Finish(const std::string& sound_wav) override {
    if (!ffmpeg_) return vm::Fail(vm::Errc::kUnavailable, "the film '" + path_ + "' has ended");
    if (frames_ == 0) {
      return Fail({vm::Errc::kUnavailable, "there is no picture in it"});
    }
    if (auto closed = feeder_->Close(); !closed) return Fail(std::move(closed.error()));
    if (auto ended = ffmpeg_->Finish(); !ended) return Fail(std::move(ended.error()));
    feeder_.reset();
    ffmpeg_.reset();
    vm::Result<void> sounded;
    if (!sound_wav.empty()) sounded = AddSound(sound_wav);
    if (auto placed = draft_.TakePlace(); !placed) return Fail(std::move(placed.error()));
    return sounded;
  }

 private:
  /// Replaces the draft by one with sound; on failure the silent one is kept.
  vm::Result<void> AddSound(const std::string& sound) {
    vm::Result<void> done = vm::CheckReadable(sound);
    auto with_sound = vm::DraftFile::Beside(draft_.name());
    if (done && !with_sound) done = std::unexpected(with_sound.error());
    if (done) {
      auto ffmpeg = FfmpegProcess::Start(
          SoundArguments(kind_, draft_.name(), sound, comment_, with_sound->name()));
      done = ffmpeg ? (*ffmpeg)->Finish() : std::unexpected(ffmpeg.error());
    }
    if (done) done = with_sound->TakePlace();
    if (done) return {};
    return vm::Fail(vm::Errc::kUnavailable, "the film '" + path_ + "' is kept without its sound '" +
                                                sound + "': " + done.error().text);
  }

  std::unexpected<vm::Error> Fail(vm::Error error) {
    feeder_.reset();
    ffmpeg_.reset();
    error.text = "cannot make the film '" + path_ + "': " + error.text;
    return std::unexpected(std::move(error));
  }

  const FilmKind& kind_;  // in a static table
  const std::string comment_;
  std::string path_;
  vm::DraftFile draft_;
  int width_;
  int height_;
  int frames_ = 0;
  std::unique_ptr<FfmpegProcess> ffmpeg_;  // null once ended
  std::optional<FrameFeeder> feeder_;      // exists as long as the process
};

/// Writes raw frames at once to a file or a pipe.
class RawFilmWriter : public FilmWriter {
 public:
  RawFilmWriter(std::string path, int width, int height, int fd, bool is_pipe)
      : path_(std::move(path)), width_(width), height_(height), fd_(fd), is_pipe_(is_pipe) {}
  ~RawFilmWriter() override { Close(); }

  vm::Result<void> Add(const Image& frame) override {
    if (auto fits = CheckFrame(frame, width_, height_, path_); !fits) return fits;
    for (std::span<const std::uint8_t> left(frame.rgba); fd_ >= 0 && !left.empty();) {
      const auto written = write(fd_, left.data(), left.size());
      if (written > 0) {
        left = left.subspan(static_cast<std::size_t>(written));
      } else if (written == 0) {  // leaves errno as it was
        return Fail("it takes no bytes");
      } else if (errno == EAGAIN) {
        pollfd room{fd_, POLLOUT, 0};
        if (poll(&room, 1, kReaderLimitMs) == 0) return Fail("nobody takes the frames");
      } else if (errno != EINTR) {
        return Fail(std::generic_category().message(errno));
      }
    }
    if (fd_ < 0) return vm::Fail(vm::Errc::kUnavailable, "the film '" + path_ + "' has ended");
    return {};
  }

  vm::Result<void> Finish(const std::string& sound_wav) override {
    Close();
    if (sound_wav.empty()) return {};
    return vm::Fail(vm::Errc::kUnavailable,
                    "raw frames carry no sound; '" + path_ + "' is without '" + sound_wav + "'");
  }
  bool is_live() const override { return is_pipe_; }

 private:
  static constexpr int kReaderLimitMs = 5000;

  void Close() {
    if (fd_ >= 0) close(std::exchange(fd_, -1));
  }
  std::unexpected<vm::Error> Fail(const std::string& why) {
    Close();
    return vm::Fail(vm::Errc::kUnavailable, "cannot write frames to '" + path_ + "': " + why);
  }

  std::string path_;
  int width_;
  int height_;
  int fd_;
  bool is_pipe_;
};

vm::Result<std::unique_ptr<FilmWriter>> OpenRaw(const std::string& path, int width, int height) {
  struct stat state {};
  const bool is_pipe = stat(path.c_str(), &state) == 0 && S_ISFIFO(state.st_mode);
  if (!is_pipe) {
    if (auto fit = vm::CheckWritable(path); !fit) return std::unexpected(std::move(fit.error()));
  }
  // Non-blocking, so that a pipe without a reader is an error at once.
  const int fd = open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC | O_NONBLOCK, 0666);
  if (fd < 0) {
    return vm::Fail(
        vm::Errc::kUnavailable,
        "cannot write frames to '" + path + "': " +
            (errno == ENXIO ? "nobody reads that pipe" : std::generic_category().message(errno)));
  }
  return std::make_unique<RawFilmWriter>(path, width, height, fd, is_pipe);
}

}  // namespace

vm::Result<void> FilmWriter::CheckName(const std::string& path) {
  if (IsRaw(path) || FilmKindOf(path) != nullptr) return {};
  return vm::Fail(vm::Errc::kBadValue,
                  "'" + path +
                      "' is no film's name: it must end in .mp4, or, to keep what is transparent, "
                      ".mov or .webm, or .mkv, to lose nothing (or .rgba, raw frames)");
}

vm::Result<std::unique_ptr<FilmWriter>> FilmWriter::Open(const std::string& path, int width,
                                                         int height, double frames_per_second,
                                                         const std::string& comment) {
  if (auto fit = CheckName(path); !fit) return std::unexpected(std::move(fit.error()));
  if (width < 1 || height < 1 || width > kMaxImageSide || height > kMaxImageSide ||
      !(frames_per_second >= 1 && frames_per_second <= kMaxFramesPerSecond)) {
    return vm::Fail(vm::Errc::kBadValue,
                    "a film cannot be " + std::to_string(width) + " x " + std::to_string(height) +
                        " at " + fmt::format("{:g}", frames_per_second) + " per second");
  }
  if (IsRaw(path)) return OpenRaw(path, width, height);
  if (auto fit = vm::CheckWritable(path); !fit) return std::unexpected(std::move(fit.error()));
  const FilmKind& kind = *FilmKindOf(path);
  const auto cannot = [&path](const vm::Error& why) {
    return vm::Fail(vm::Errc::kUnavailable, "cannot make the film '" + path + "': " + why.text);
  };
  auto draft = vm::DraftFile::Beside(path);
  if (!draft) return cannot(draft.error());
  auto ffmpeg = FfmpegProcess::Start(
      EncodeArguments(kind, width, height, frames_per_second, comment, draft->name()));
  if (!ffmpeg) return cannot(ffmpeg.error());
  return std::make_unique<FfmpegFilmWriter>(kind, comment, path, *std::move(draft), width, height,
                                            *std::move(ffmpeg));
}

}  // namespace fsm
