#include "face_fit/image/photo.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "face_fit/image/filters.h"
#include "fsm/image/byte_order.h"
#include "fsm/image/image_codec.h"
#include "vm_protocol/core/text_file.h"

namespace facefit {
namespace {

constexpr std::uint8_t kPngStart[] = {0x89, 'P', 'N', 'G', 13, 10, 26, 10};
constexpr std::int64_t kMaxPixels = 50'000'000;
/// Shortest side, pixels; smaller photos show nothing of a face.
constexpr int kMinSize = 64;

bool StartsWith(std::span<const std::uint8_t> bytes, std::span<const std::uint8_t> start) {
  return bytes.size() >= start.size() && std::ranges::equal(bytes.first(start.size()), start);
}

/// Decodes a JPEG. Of several EXIF blocks the last one with an orientation counts.
vm::Result<fsm::Image> DecodeJpegPhoto(std::span<const std::uint8_t> bytes, int most_size,
                                       int& orientation) {
  auto decoded = fsm::DecodeJpegAs({.most_pixels = kMaxPixels, .enough_side = most_size}, bytes);
  if (!decoded) return std::unexpected(decoded.error());
  for (const auto& block : decoded->exif) {
    if (const int found = ExifOrientation(block); found != 1) orientation = found;
  }
  return std::move(decoded->image);
}

vm::Result<fsm::Image> DecodePngPhoto(std::span<const std::uint8_t> bytes) {
  // The first chunk holds width and height; they are checked before anything is decoded.
  if (bytes.size() < 24) return vm::Fail(vm::Errc::kBadValue, "the PNG file ends too early");
  const std::int64_t width = fsm::BigEndian(bytes, 16, 4), height = fsm::BigEndian(bytes, 20, 4);
  if (width > kMaxPixels || height > kMaxPixels || width * height > kMaxPixels) {
    return vm::Fail(
        vm::Errc::kBadValue,
        fmt::format("the photo has {} x {} pixels; at most {} million are read: scale it down",
                    width, height, kMaxPixels / 1'000'000));
  }
  auto image = fsm::DecodePng(bytes);
  if (!image) {
    return vm::Fail(vm::Errc::kBadValue, "the PNG file cannot be read: " + image.error().text);
  }
  // Composite transparent pixels on white.
  for (std::size_t i = 0; i < image->rgba.size(); i += 4) {
    const unsigned a = image->rgba[i + 3];
    for (std::size_t c = 0; c < 3; ++c) {
      image->rgba[i + c] =
          static_cast<std::uint8_t>((image->rgba[i + c] * a + 255U * (255U - a) + 127U) / 255U);
    }
    image->rgba[i + 3] = 255;
  }
  return image;
}

}  // namespace

vm::Result<fsm::Image> DecodePhoto(std::span<const std::uint8_t> bytes, int most_size) {
  constexpr std::uint8_t kJpegStart[] = {0xff, 0xd8, 0xff};
  int orientation = 1;
  vm::Result<fsm::Image> image =
      StartsWith(bytes, kJpegStart)  ? DecodeJpegPhoto(bytes, most_size, orientation)
      : StartsWith(bytes, kPngStart) ? DecodePngPhoto(bytes)
                                     : vm::Fail(vm::Errc::kBadValue,
                                                "not a picture that is read here: a JPEG or PNG "
                                                "file is expected");
  if (!image) return image;
  if (std::min(image->width, image->height) < kMinSize) {
    return vm::Fail(
        vm::Errc::kBadValue,
        fmt::format("the photo is only {} x {} pixels; at least {} on each side are needed",
                    image->width, image->height, kMinSize));
  }
  *image = ScaledToFit(std::move(*image), most_size);
  if (orientation != 1) *image = OrientedByExif(*image, orientation);
  return image;
}

vm::Result<fsm::Image> ReadPhoto(const std::string& path, int most_size) {
  constexpr std::size_t kMaxFileBytes = 200'000'000;
  const auto bytes = vm::ReadTextFile(path, kMaxFileBytes);
  if (!bytes) return std::unexpected(bytes.error());
  auto image = DecodePhoto(fsm::BytesOf(*bytes), most_size);
  if (!image) return vm::Fail(image.error().code, "'" + path + "': " + image.error().text);
  return image;
}

int ExifOrientation(std::span<const std::uint8_t> block) {
  constexpr std::uint8_t kStart[] = {'E', 'x', 'i', 'f', 0, 0};
  if (!StartsWith(block, kStart)) return 1;
  const auto tiff = block.subspan(sizeof kStart);
  if (tiff.size() < 8) return 1;
  const bool little = tiff[0] == 'I';
  const auto number = [&](std::size_t at, std::size_t bytes) -> std::uint32_t {
    if (at > tiff.size() || tiff.size() - at < bytes) return 0;
    return little ? fsm::LittleEndian(tiff, at, bytes) : fsm::BigEndian(tiff, at, bytes);
  };
  const std::size_t list = number(4, 4);
  const std::uint32_t entries = number(list, 2);
  constexpr std::uint32_t kOrientation = 0x0112;
  for (std::uint32_t i = 0; i < entries; ++i) {
    const std::size_t entry = list + 2 + 12 * static_cast<std::size_t>(i);
    if (entry + 12 > tiff.size()) return 1;
    if (number(entry, 2) != kOrientation) continue;
    const std::uint32_t value = number(entry + 8, 2);
    return value >= 1 && value <= 8 ? static_cast<int>(value) : 1;
  }
  return 1;
}

}  // namespace facefit
