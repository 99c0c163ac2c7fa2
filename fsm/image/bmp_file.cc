#include "fsm/image/byte_order.h"
#include "fsm/image/image_codec.h"

namespace fsm {
namespace {

// Windows bitmaps: a 14-byte file header ("BM", file size, 4 unused bytes, offset of the pixels),
// then an information header that begins with its own size. Rows are padded to 4 bytes and run
// upward unless the height is negative; pixels are blue, green, red.
constexpr std::uint32_t kFileHeader = 14;
constexpr std::uint32_t kInfoHeader = 40;
constexpr std::uint32_t kUncompressed = 0;
constexpr std::uint32_t kBitFields = 3;

std::size_t Stride(int width, std::size_t bytes_per_pixel) {
  return (static_cast<std::size_t>(width) * bytes_per_pixel + 3) / 4 * 4;
}

/// Tells whether bit fields, if present, are the usual masks of uncompressed 32-bit pixels.
bool UsualMasks(std::span<const std::uint8_t> bytes) {
  constexpr std::size_t kMasks = kFileHeader + kInfoHeader;
  return bytes.size() >= kMasks + 12 && LittleEndian(bytes, kMasks, 4) == 0x00ff0000 &&
         LittleEndian(bytes, kMasks + 4, 4) == 0x0000ff00 &&
         LittleEndian(bytes, kMasks + 8, 4) == 0x000000ff;
}

}  // namespace

std::vector<std::uint8_t> EncodeBmp(const Image& image) {
  const std::size_t stride = Stride(image.width, 3);
  const std::size_t pixels = stride * static_cast<std::size_t>(image.height);
  std::vector<std::uint8_t> out{'B', 'M'};
  out.reserve(kFileHeader + kInfoHeader + pixels);
  AppendLittleEndian(out, static_cast<std::uint32_t>(kFileHeader + kInfoHeader + pixels), 4);
  AppendLittleEndian(out, 0, 4);
  AppendLittleEndian(out, kFileHeader + kInfoHeader, 4);
  AppendLittleEndian(out, kInfoHeader, 4);
  AppendLittleEndian(out, static_cast<std::uint32_t>(image.width), 4);
  AppendLittleEndian(out, static_cast<std::uint32_t>(image.height), 4);
  AppendLittleEndian(out, 1, 2);   // planes
  AppendLittleEndian(out, 24, 2);  // bits per pixel
  AppendLittleEndian(out, kUncompressed, 4);
  AppendLittleEndian(out, static_cast<std::uint32_t>(pixels), 4);
  AppendLittleEndian(out, 2835, 4);  // pixels per metre in x and y: 72 per inch
  AppendLittleEndian(out, 2835, 4);
  AppendLittleEndian(out, 0, 4);  // no palette and no important colours
  AppendLittleEndian(out, 0, 4);
  for (int y = image.height - 1; y >= 0; --y) {
    const std::size_t row = static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width);
    for (std::size_t x = 0; x < static_cast<std::size_t>(image.width); ++x) {
      const auto* pixel = &image.rgba[(row + x) * 4];
      out.insert(out.end(), {pixel[2], pixel[1], pixel[0]});
    }
    out.resize((out.size() - (kFileHeader + kInfoHeader) + 3) / 4 * 4 + kFileHeader + kInfoHeader);
  }
  return out;
}

vm::Result<Image> DecodeBmp(std::span<const std::uint8_t> bytes) {
  if (bytes.size() < kFileHeader + kInfoHeader || bytes[0] != 'B' || bytes[1] != 'M') {
    return vm::Fail(vm::Errc::kBadValue, "it is not a bitmap file");
  }
  if (LittleEndian(bytes, 14, 4) < kInfoHeader) {
    return vm::Fail(vm::Errc::kBadValue, "it is an OS/2 bitmap");
  }
  const std::size_t start = LittleEndian(bytes, 10, 4);
  const auto width = static_cast<std::int32_t>(LittleEndian(bytes, 18, 4));
  const auto signed_height = static_cast<std::int32_t>(LittleEndian(bytes, 22, 4));
  const bool downwards = signed_height < 0;
  const std::int64_t height = downwards ? -static_cast<std::int64_t>(signed_height) : signed_height;
  const std::size_t bits = LittleEndian(bytes, 28, 2);
  const auto compression = LittleEndian(bytes, 30, 4);
  if (auto fits = CheckSize(width, height); !fits) return std::unexpected(fits.error());
  if (bits != 24 && bits != 32) {
    return vm::Fail(vm::Errc::kBadValue,
                    "it has " + std::to_string(bits) + " bits per pixel, only 24 and 32 are read");
  }
  if (compression != kUncompressed &&
      !(compression == kBitFields && bits == 32 && UsualMasks(bytes))) {
    return vm::Fail(vm::Errc::kBadValue, "it is compressed");
  }
  const std::size_t stride = Stride(width, bits / 8);
  const std::size_t needed = stride * static_cast<std::size_t>(height);
  if (start > bytes.size() || bytes.size() - start < needed) {
    return vm::Fail(vm::Errc::kBadValue, "it ends too early");
  }
  Image image = FilledImage(width, static_cast<int>(height), kBlack);
  for (std::size_t y = 0; y < static_cast<std::size_t>(height); ++y) {
    const std::size_t row = downwards ? y : static_cast<std::size_t>(height) - 1 - y;
    const auto line = bytes.subspan(start + row * stride, stride);
    for (std::size_t x = 0; x < static_cast<std::size_t>(width); ++x) {
      // The fourth byte of 32-bit pixels is ignored: most programs write zero there.
      auto* pixel = &image.rgba[(y * static_cast<std::size_t>(width) + x) * 4];
      for (std::size_t c = 0; c < 3; ++c) pixel[c] = line[x * bits / 8 + 2 - c];
    }
  }
  return image;
}

}  // namespace fsm
