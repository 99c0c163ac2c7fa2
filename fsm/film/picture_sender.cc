#include "fsm/film/picture_sender.h"

#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cassert>
#include <cerrno>

#include "fsm/image/image_codec.h"
#include "vm_protocol/runtime/unix_socket.h"

namespace fsm {
namespace {

constexpr std::chrono::milliseconds kPollInterval{50};  // between checks of closing_

/// Returns header and JPEG; empty if the picture cannot be compressed.
std::vector<std::uint8_t> PictureMessage(vm::Time at, const Image& picture) {
  const auto jpeg = EncodeJpeg(picture, PictureSender::kQuality);
  if (jpeg.empty()) return {};
  const std::string head = "picture " + vm::FormatMs(at) + " " + std::to_string(jpeg.size()) + "\n";
  std::vector<std::uint8_t> record(head.begin(), head.end());
  record.insert(record.end(), jpeg.begin(), jpeg.end());
  return record;
}

}  // namespace

vm::Result<std::unique_ptr<PictureSender>> PictureSender::Connect(const std::string& path,
                                                                  std::chrono::milliseconds stall) {
  const auto fd = vm::ConnectUnix(path);
  if (!fd) {
    return vm::Fail(fd.error().code, "nobody takes pictures at '" + path + "': " + fd.error().text);
  }
  return std::unique_ptr<PictureSender>(new PictureSender(*fd, stall));
}

PictureSender::~PictureSender() {
  {
    const std::lock_guard lock(mutex_);
    closing_ = true;
  }
  changed_.notify_all();
  thread_.join();
  close(fd_);
}

bool PictureSender::full() {
  const std::lock_guard lock(mutex_);
  return waiting_.has_value();
}

bool PictureSender::closing() {
  const std::lock_guard lock(mutex_);
  return closing_;
}

bool PictureSender::gone() {
  // A receiver sends nothing, so only the end of the stream can be read.
  char byte;
  if (recv(fd_, &byte, 1, MSG_PEEK | MSG_DONTWAIT) == 0) return true;
  const std::lock_guard lock(mutex_);
  return gone_;
}

void PictureSender::Send(const Image& picture, vm::Time at) {
  {
    const std::lock_guard lock(mutex_);
    assert(!waiting_);
    Image copy = std::move(spare_);
    copy.width = picture.width;
    copy.height = picture.height;
    copy.rgba.assign(picture.rgba.begin(), picture.rgba.end());
    waiting_.emplace(at, std::move(copy));
  }
  changed_.notify_all();
}

void PictureSender::Run() {
  std::unique_lock lock(mutex_);
  for (;;) {
    changed_.wait(lock, [this] { return waiting_ || closing_; });
    if (closing_) return;
    auto [at, picture] = *std::exchange(waiting_, std::nullopt);
    lock.unlock();
    const bool sent = SendAll(PictureMessage(at, picture));
    lock.lock();
    spare_ = std::move(picture);
    if (sent) continue;
    gone_ = true;
    return;
  }
}

bool PictureSender::SendAll(const std::vector<std::uint8_t>& bytes) {
  std::chrono::milliseconds waited{0};
  for (std::size_t done = 0; done < bytes.size();) {
    const ssize_t n =
        send(fd_, bytes.data() + done, bytes.size() - done, MSG_NOSIGNAL | MSG_DONTWAIT);
    if (n > 0) {
      done += static_cast<std::size_t>(n);
      waited = waited.zero();
      continue;
    }
    if (errno == EINTR) continue;
    if (errno != EAGAIN || closing() || waited >= stall_) return false;
    pollfd room{fd_, POLLOUT, 0};
    if (poll(&room, 1, static_cast<int>(kPollInterval.count())) == 0) waited += kPollInterval;
  }
  return true;
}

}  // namespace fsm
