#include "fsm/image/image_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cassert>
#include <cerrno>
#include <system_error>
#include <utility>

#include "fsm/image/byte_order.h"
#include "fsm/image/image_codec.h"
#include "vm_protocol/core/file_kind.h"
#include "vm_protocol/core/lower_case.h"
#include "vm_protocol/core/text_file.h"

namespace fsm {
namespace {

/// This exceeds an uncompressed picture of the largest size.
constexpr std::size_t kMaxFileBytes = 300U << 20;

struct Format {
  const char* ending;
  std::vector<std::uint8_t> (*encode)(const Image&);
  vm::Result<Image> (*decode)(std::span<const std::uint8_t>);
};

constexpr Format kFormats[] = {{".png", EncodePng, DecodePng},
                               {".bmp", EncodeBmp, DecodeBmp},
                               {".rgb", EncodeSgi, DecodeSgi},
                               {".jpg", nullptr, DecodeJpeg},
                               {".jpeg", nullptr, DecodeJpeg}};

const Format* FormatOf(const std::string& path) {
  const std::string lower = vm::LowerCase(path);
  const auto found = std::ranges::find_if(
      kFormats, [&lower](const Format& format) { return lower.ends_with(format.ending); });
  return found == std::end(kFormats) ? nullptr : found;
}

std::unexpected<vm::Error> FailByEnding(const std::string& path, const char* more = "") {
  return vm::Fail(vm::Errc::kBadValue,
                  "'" + path + "' is no picture's name: it must end in .png, .bmp or .rgb" + more);
}

std::unexpected<vm::Error> FailToWrite(const std::string& path) {
  return vm::Fail(vm::Errc::kUnavailable,
                  "cannot write '" + path + "': " + std::generic_category().message(errno));
}

class File {
 public:
  explicit File(int fd) : fd_(fd) {}
  ~File() {
    if (fd_ >= 0) close(fd_);
  }
  File(const File&) = delete;
  File& operator=(const File&) = delete;
  bool open() const { return fd_ >= 0; }
  int get() const { return fd_; }
  /// Returns false if the system reports only now that a write failed.
  bool Close() { return close(std::exchange(fd_, -1)) == 0; }

 private:
  int fd_;
};

bool WriteAll(int fd, std::span<const std::uint8_t> bytes) {
  while (!bytes.empty()) {
    const auto written = write(fd, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return false;
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
  return true;
}

}  // namespace

vm::Result<void> WriteImage(const Image& image, const std::string& path) {
  assert(image.IsWhole());
  const Format* format = FormatOf(path);
  if (!format || !format->encode) return FailByEnding(path);
  if (auto fit = vm::CheckWritable(path); !fit) return fit;
  const auto bytes = format->encode(image);
  // The file is written under a temporary name and then renamed, so nobody reads half a picture.
  const std::string beside = path + ".part" + std::to_string(getpid());
  if (auto fit = vm::CheckWritable(beside); !fit) return fit;
  File file(open(beside.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666));
  if (!file.open()) return FailToWrite(path);
  if (!WriteAll(file.get(), bytes) || !file.Close() || rename(beside.c_str(), path.c_str()) != 0) {
    const auto failed = FailToWrite(path);
    unlink(beside.c_str());
    return failed;
  }
  return {};
}

vm::Result<Image> ReadImage(const std::string& path) {
  const Format* format = FormatOf(path);
  if (!format) return FailByEnding(path, " (or .jpg, to be read)");
  const auto bytes = vm::ReadTextFile(path, kMaxFileBytes);
  if (!bytes) return std::unexpected(bytes.error());
  auto image = format->decode(BytesOf(*bytes));
  if (image) return image;
  return vm::Fail(vm::Errc::kBadValue,
                  "cannot use the picture '" + path + "': " + image.error().text);
}

}  // namespace fsm
