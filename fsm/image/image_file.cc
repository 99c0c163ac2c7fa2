#include "fsm/image/image_file.h"

#include <algorithm>
#include <cassert>

#include "fsm/image/byte_order.h"
#include "fsm/image/image_codec.h"
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

}  // namespace

vm::Result<void> WriteImage(const Image& image, const std::string& path) {
  assert(image.IsWhole());
  const Format* format = FormatOf(path);
  if (!format || !format->encode) return FailByEnding(path);
  const auto bytes = format->encode(image);
  return vm::WriteTextFile(path, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
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
