#include "agent_manager/web/face_video.h"

#include <cstddef>
#include <cstdio>
// After <cstdio>, which it needs and does not include.
#include <fcntl.h>
#include <jpeglib.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <boost/asio/post.hpp>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <csetjmp>
#include <cstdint>
#include <cstdlib>
#include <sstream>
#include <utility>
#include <vector>

#include "agent_manager/routing/own_names.h"
#include "vm_protocol/core/guarded.h"

namespace am {
namespace {

constexpr int kQuality = 80;
constexpr const char* kFace = "FSM";

/// Limits of a picture's sides and of its area; 4096 * 4096 pixels are 64 MiB.
constexpr int kMaxSide = 8192;
constexpr std::int64_t kMaxPixels = 4096 * 4096;

/// Replaces libjpeg's own error handler, which ends the program.
struct JpegErrors {
  jpeg_error_mgr manager{};  // first, since libjpeg has only a pointer to this member
  std::jmp_buf back{};
};
[[noreturn]] void OnJpegError(j_common_ptr jpeg) {
  std::longjmp(reinterpret_cast<JpegErrors*>(jpeg->err)->back, 1);
}

/// `rgba`: width x height x 4, top row first. Empty if libjpeg fails.
std::string Compress(const std::vector<unsigned char>& rgba, int width, int height) {
  jpeg_compress_struct jpeg{};
  JpegErrors errors;
  unsigned char* bytes = nullptr;
  unsigned long size = 0;
  jpeg.err = jpeg_std_error(&errors.manager);
  errors.manager.error_exit = OnJpegError;
  // longjmp skips destructors: no object that has one is created before compressing has ended.
  const bool failed = setjmp(errors.back) != 0;
  if (!failed) {
    jpeg_create_compress(&jpeg);
    jpeg_mem_dest(&jpeg, &bytes, &size);
    jpeg.image_width = static_cast<JDIMENSION>(width);
    jpeg.image_height = static_cast<JDIMENSION>(height);
    jpeg.input_components = 4;
    jpeg.in_color_space = JCS_EXT_RGBX;
    jpeg_set_defaults(&jpeg);
    jpeg_set_quality(&jpeg, kQuality, TRUE);
    jpeg_start_compress(&jpeg, TRUE);
    while (jpeg.next_scanline < jpeg.image_height) {
      JSAMPROW row = const_cast<JSAMPROW>(rgba.data() +
                                          static_cast<std::size_t>(width) * 4 * jpeg.next_scanline);
      jpeg_write_scanlines(&jpeg, &row, 1);
    }
    jpeg_finish_compress(&jpeg);
  }
  jpeg_destroy_compress(&jpeg);
  std::string picture;
  if (!failed) picture.assign(reinterpret_cast<const char*>(bytes), size);
  std::free(bytes);
  return picture;
}

}  // namespace

FaceVideo::FaceVideo(const vm::Scheduler& clock, boost::asio::io_context& io, Hub& hub)
    : clock_(clock), io_(io), hub_(hub) {}
FaceVideo::~FaceVideo() {
  *alive_ = false;
  End();
}

unsigned FaceVideo::Watch(Audience::Member viewer) {
  const unsigned number = viewers_.Join(std::move(viewer));
  if (!beginning_ && !thread_.joinable()) Begin();
  return number;
}

void FaceVideo::Leave(unsigned viewer) {
  viewers_.Leave(viewer);
  if (viewers_.empty() && !beginning_) Stop();
}

void FaceVideo::Stop() {
  if (stopping_ || !recording_) return;
  stopping_ = true;
  const auto stopped = [this](const vm::Result<std::string>&) {
    stopping_ = false;
    recording_ = false;
    End();
    if (!viewers_.empty()) Begin();  // a viewer has come meanwhile
  };
  Ask("Record", "STOP", [this, stopped](const vm::Result<std::string>& answer) {
    if (!stopping_) return;  // the face has gone meanwhile
    if (old_fps_.empty()) return stopped(answer);
    Ask("Record.fps", old_fps_, [this, stopped](const vm::Result<std::string>& set) {
      if (stopping_) stopped(set);
    });
  });
}

void FaceVideo::Ask(const std::string& slot, const std::string& value,
                    std::function<void(const vm::Result<std::string>&)> next) {
  const vm::Message message = value.empty() ? vm::Inq(slot) : vm::Set(slot, value);
  hub_.Ask(own_name::kHub, vm::To(kFace, message),
           [alive = alive_, next = std::move(next)](const vm::Result<std::string>& answer) {
             if (*alive) next(answer);
           });
}

void FaceVideo::Begin() {
  beginning_ = true;
  Ask("Window", "", [this](const vm::Result<std::string>& size) {
    if (!size) return GiveUp(size.error().text);
    int width = 0, height = 0;
    std::istringstream(*size) >> width >> height;
    const bool fits = width > 0 && height > 0 && width <= kMaxSide && height <= kMaxSide &&
                      std::int64_t{width} * height <= kMaxPixels;
    if (!fits) return GiveUp("no picture can be of the face's size, " + *size);
    if (viewers_.empty()) return GiveUp("");
    Ask("Record.fps", "", [this, width, height](const vm::Result<std::string>& fps) {
      old_fps_ = fps.value_or("");
      Ask("Record", "", [this, width, height](const vm::Result<std::string>& record) {
        if (!record) return GiveUp(record.error().text);
        // Setting Record would end a film that the face is recording for somebody else.
        if (*record != "STOP") return GiveUp("the face records the film " + *record);
        Open(width, height);
      });
    });
  });
}

void FaceVideo::GiveUp(const std::string& why) {
  beginning_ = false;
  End();
  viewers_.End(why);
}

void FaceVideo::Open(int width, int height) {
  if (!folder_.Make("face", "face.rgba")) return GiveUp("no folder for the pictures");
  const char* const pipe = folder_.file().c_str();
  if (mkfifo(pipe, 0600) != 0) return GiveUp("no pipe for the pictures");
  frames_fd_ = open(pipe, O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  stop_fd_ = eventfd(0, EFD_CLOEXEC);
  if (frames_fd_ < 0 || stop_fd_ < 0) return GiveUp("no pipe for the pictures");
  Ask("Record.fps", std::to_string(kFramesPerSecond),
      [this, width, height](const vm::Result<std::string>&) {
        Ask("Record", folder_.file(), [this, width, height](const vm::Result<std::string>& begun) {
          if (!begun) return GiveUp(begun.error().text);
          recording_ = true;
          beginning_ = false;
          // Before anything is asked: the face answers nothing while its pipe is full.
          thread_ = std::thread([this, width, height] {
            // A thread's errors end the film, as a face that writes no more does.
            if (!vm::Guarded([&] { ReadFrames(width, height); }))
              static_cast<void>(vm::Guarded([this] { Post(0, ""); }));
          });
          AskStart();
          if (viewers_.empty()) Stop();
        });
      });
}

void FaceVideo::AskStart() {
  started_.reset();
  Ask("Record.start", "", [this](const vm::Result<std::string>& ms) {
    double start = 0;
    if (ms && recording_ && std::istringstream(*ms) >> start)
      started_ = vm::Time(std::llround(start * 1000));
  });
}

void FaceVideo::Post(long number, std::string picture) {
  boost::asio::post(io_, [this, alive = alive_, number, picture = std::move(picture)]() mutable {
    if (!*alive) return;
    if (picture.empty()) return EndFrames();
    Deliver(number, std::move(picture));
  });
}

void FaceVideo::ReadFrames(int width, int height) {
  std::vector<unsigned char> frame(static_cast<std::size_t>(width) *
                                   static_cast<std::size_t>(height) * 4);
  std::size_t filled = 0;
  for (long number = 0;;) {
    std::array<pollfd, 2> waits{{{frames_fd_, POLLIN, 0}, {stop_fd_, POLLIN, 0}}};
    poll(waits.data(), waits.size(), -1);
    if (waits[1].revents != 0) return;
    const ssize_t n = read(frames_fd_, frame.data() + filled, frame.size() - filled);
    if (n < 0 && errno != EAGAIN && errno != EINTR) return Post(0, "");
    if (n < 0) continue;             // spurious wake-up
    if (n == 0) return Post(0, "");  // the face has stopped writing, or has gone
    filled += static_cast<std::size_t>(n);
    if (filled < frame.size()) continue;
    filled = 0;
    std::string picture = Compress(frame, width, height);
    if (picture.empty()) return Post(0, "");
    Post(number++, std::move(picture));
  }
}

void FaceVideo::Deliver(long number, std::string picture) {
  const vm::Time at = started_ ? *started_ - hub_.clocks().ClockOf(kFace).offset +
                                     vm::Time(std::chrono::seconds(number)) / kFramesPerSecond
                               : clock_.Now();
  viewers_.Tell(std::make_shared<const LivePiece>(
      LivePiece{.kind = LivePiece::Kind::kPicture, .at = at, .bytes = std::move(picture)}));
}

void FaceVideo::EndFrames() {
  if (stopping_) return;  // the end that Stop has asked for
  recording_ = false;
  if (!beginning_) End();
  viewers_.End("the face draws no more");
}

void FaceVideo::End() {
  if (thread_.joinable()) {
    const std::uint64_t one = 1;
    static_cast<void>(!write(stop_fd_, &one, sizeof(one)));
    thread_.join();
  }
  if (std::exchange(recording_, false) && hub_.directory().IsPresent(kFace)) {
    hub_.Ask(own_name::kHub, vm::To(kFace, vm::Set("Record", "STOP")), IgnoreAnswer);
    if (!old_fps_.empty())
      hub_.Ask(own_name::kHub, vm::To(kFace, vm::Set("Record.fps", old_fps_)), IgnoreAnswer);
  }
  for (int* fd : {&frames_fd_, &stop_fd_}) {
    if (*fd >= 0) close(std::exchange(*fd, -1));
  }
  folder_.Remove();
}

}  // namespace am
