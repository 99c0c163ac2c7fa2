#include "face_track/film/picture_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <vector>

#include "face_fit/image/photo.h"
#include "face_track/film/ffmpeg_source.h"
#include "vm_protocol/core/lower_case.h"

namespace facetrack {
namespace {

namespace fs = std::filesystem;

bool IsPhoto(const fs::path& path) {
  const std::string end = vm::LowerCase(path.extension().string());
  return end == ".png" || end == ".jpg" || end == ".jpeg";
}

class FolderSource : public PictureSource {
 public:
  FolderSource(std::vector<std::string> files, double rate, int most_side)
      : files_(std::move(files)), rate_(rate), most_side_(most_side) {}
  vm::Result<bool> Next(TimedPicture& out) override {
    if (at_ == files_.size()) return false;
    auto photo = facefit::ReadPhoto(files_[at_], most_side_);
    if (!photo) return std::unexpected(photo.error());
    if (at_ > 0 && (photo->width != width_ || photo->height != height_)) {
      return vm::Fail(vm::Errc::kBadValue,
                      fmt::format("'{}' is {} x {}, the pictures before it {} x {}: all of a "
                                  "folder are of one size",
                                  files_[at_], photo->width, photo->height, width_, height_));
    }
    width_ = photo->width;
    height_ = photo->height;
    out.picture = std::move(*photo);
    out.ms = 1000 * static_cast<double>(at_++) / rate_;
    return true;
  }
  std::optional<double> length_ms() const override {
    return 1000 * static_cast<double>(files_.size()) / rate_;
  }

 private:
  const std::vector<std::string> files_;
  const double rate_;
  const int most_side_;
  std::size_t at_ = 0;
  int width_ = 0, height_ = 0;
};

vm::Result<std::unique_ptr<PictureSource>> OpenFolder(const std::string& name, double rate,
                                                      int most_side) {
  constexpr std::size_t kMostPictures = 1'000'000;
  std::vector<std::string> files;
  std::error_code error;
  for (fs::directory_iterator at(name, error), end; !error && at != end; at.increment(error)) {
    if (!IsPhoto(at->path())) continue;
    if (files.size() == kMostPictures) {
      return vm::Fail(vm::Errc::kLimit, "'" + name + "' holds more than a million pictures");
    }
    files.push_back(at->path());
  }
  if (error) return vm::Fail(vm::Errc::kUnavailable, "'" + name + "': " + error.message());
  if (files.empty()) {
    return vm::Fail(vm::Errc::kBadValue, "'" + name + "' holds no .png and no .jpg");
  }
  std::ranges::sort(files);
  return std::make_unique<FolderSource>(std::move(files), rate, most_side);
}

std::vector<std::string> Words(const std::string& text) {
  std::vector<std::string> words;
  std::size_t at = 0;
  while ((at = text.find_first_not_of(' ', at)) != std::string::npos) {
    const auto end = std::min(text.find(' ', at), text.size());
    words.push_back(text.substr(at, end - at));
    at = end;
  }
  return words;
}

/// Only options of inputs that take a value: any other word could be a file that ffmpeg writes.
constexpr std::string_view kInputOptions[] = {"-f",
                                              "-i",
                                              "-framerate",
                                              "-video_size",
                                              "-pixel_format",
                                              "-input_format",
                                              "-ss",
                                              "-t",
                                              "-r",
                                              "-stream_loop",
                                              "-rtsp_transport",
                                              "-rtbufsize",
                                              "-re",
                                              "-thread_queue_size"};

vm::Result<std::vector<std::string>> InputWords(const std::string& text) {
  std::vector<std::string> words = Words(text);
  std::size_t inputs = 0;
  for (std::size_t i = 0; i < words.size(); i += words[i] == "-re" ? 1 : 2) {
    if (std::ranges::find(kInputOptions, words[i]) == std::end(kInputOptions) ||
        (words[i] != "-re" && i + 1 == words.size()) || inputs > 0) {
      return vm::Fail(
          vm::Errc::kBadValue,
          fmt::format("'ffmpeg:{}': '{}' found, options of one input expected, '-i NAME' "
                      "last; known are {}",
                      text, words[i], fmt::join(kInputOptions, " ")));
    }
    inputs += words[i] == "-i" ? 1 : 0;
  }
  if (inputs == 0) {
    return vm::Fail(vm::Errc::kBadValue, "'ffmpeg:" + text + "': '-i NAME' expected at the end");
  }
  // Filters write files, too (metadata, signature), a source of its own does not.
  if (std::ranges::find(words, "lavfi") != words.end() &&
      words.back().find_first_of(",;[") != std::string::npos) {
    return vm::Fail(vm::Errc::kBadValue,
                    "'ffmpeg:" + text + "': one source of lavfi without filters expected");
  }
  return words;
}

}  // namespace

bool IsLive(const std::string& name) {
  return name == "camera" || name.starts_with("v4l2:") || name.starts_with("ffmpeg:");
}

vm::Result<std::unique_ptr<PictureSource>> OpenPictures(const std::string& name, double rate,
                                                        int most_side) {
  const std::vector<std::string> at_once{"-fflags", "nobuffer", "-flags", "low_delay"};
  const auto camera = [&](const std::string& device) {
    auto words = at_once;
    words.insert(words.end(), {"-f", "v4l2", "-i", device});
    return FfmpegSource::Open(name, words, most_side);
  };
  if (name == "camera") return camera("/dev/video0");
  if (name.starts_with("v4l2:")) return camera(name.substr(5));
  if (name.starts_with("ffmpeg:")) {
    const auto words = InputWords(name.substr(7));
    return words ? FfmpegSource::Open(name, *words, most_side) : std::unexpected(words.error());
  }
  if (name == "-") return FfmpegSource::OpenFilm(name, most_side);
  std::error_code error;
  const auto status = fs::status(name, error);
  if (!fs::exists(status)) {
    return vm::Fail(vm::Errc::kUnavailable, "there is no '" + name + "'");
  }
  if (fs::is_directory(status)) return OpenFolder(name, rate, most_side);
  return FfmpegSource::OpenFilm(name, most_side);
}

}  // namespace facetrack
