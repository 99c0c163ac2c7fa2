#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "fsm/image/image.h"
#include "vm_protocol/core/result.h"

namespace fsm {

/// Picture formats (png_file.cc, bmp_file.cc, ...): each converts between bytes in memory and an
/// Image. All decoders accept hostile bytes. Error: kBadValue with a clause if the file is damaged,
/// too large or of an unsupported kind.

std::vector<std::uint8_t> EncodePng(const Image& image);
std::vector<std::uint8_t> EncodeBmp(const Image& image);  ///< 24 bits per pixel, without alpha
std::vector<std::uint8_t> EncodeSgi(const Image& image);  ///< uncompressed RGB, without alpha
/// Drops alpha; `quality` is libjpeg's, 1 to 100. Empty if memory is short.
std::vector<std::uint8_t> EncodeJpeg(const Image& image, int quality);

vm::Result<Image> DecodePng(std::span<const std::uint8_t> bytes);
vm::Result<Image> DecodeBmp(std::span<const std::uint8_t> bytes);
vm::Result<Image> DecodeSgi(std::span<const std::uint8_t> bytes);

/// Options for decoding a JPEG file.
struct JpegOptions {
  std::int64_t most_pixels = 50'000'000;
  /// 0: full size; otherwise the smallest of 1/1, 1/2, 1/4, 1/8 whose longer side is at least this.
  int enough_side = 0;
};
struct DecodedJpeg {
  Image image;
  std::vector<std::vector<std::uint8_t>> exif;  ///< the APP1 blocks
};
/// Decodes RGB, grey and CMYK, without applying the EXIF orientation. A truncated file is damaged.
vm::Result<DecodedJpeg> DecodeJpegAs(const JpegOptions& options,
                                     std::span<const std::uint8_t> bytes);
vm::Result<Image> DecodeJpeg(std::span<const std::uint8_t> bytes);
/// Decodes PNG or JPEG, told apart by content.
vm::Result<Image> DecodePngOrJpeg(std::span<const std::uint8_t> bytes);

/// Checks that each side is 1..kMaxImageSide before decoding continues. Error: kBadValue.
vm::Result<void> CheckSize(std::int64_t width, std::int64_t height);

}  // namespace fsm
