#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "fsm/image/image.h"
#include "vm_protocol/core/result.h"

namespace fsm {

/// Formats of pictures (png_file.cc, bmp_file.cc, ...), each between bytes in memory and an Image.
/// All decoders take hostile bytes. Error: kBadValue with a clause where the file is damaged, too
/// large or of a kind we do not read.

std::vector<std::uint8_t> EncodePng(const Image& image);
std::vector<std::uint8_t> EncodeBmp(const Image& image);  ///< 24 bit, opacity dropped
std::vector<std::uint8_t> EncodeSgi(const Image& image);  ///< uncompressed RGB, opacity dropped
/// Opacity dropped; `quality` 1 to 100 as libjpeg counts. Empty if there is no memory for it.
std::vector<std::uint8_t> EncodeJpeg(const Image& image, int quality);

vm::Result<Image> DecodePng(std::span<const std::uint8_t> bytes);
vm::Result<Image> DecodeBmp(std::span<const std::uint8_t> bytes);
vm::Result<Image> DecodeSgi(std::span<const std::uint8_t> bytes);

/// What is wanted of a JPEG file, and what it says beside its picture.
struct JpegWish {
  std::int64_t most_pixels = 50'000'000;
  /// 0: the whole picture; else the least of 1/1, 1/2, 1/4, 1/8 whose longer side is as long.
  int enough_side = 0;
  std::vector<std::vector<std::uint8_t>> exif;  ///< out: the APP1 blocks
};
/// RGB, grey and CMYK; a file that ends too early is damaged. Not turned.
vm::Result<Image> DecodeJpegAs(JpegWish& wish, std::span<const std::uint8_t> bytes);
vm::Result<Image> DecodeJpeg(std::span<const std::uint8_t> bytes);
/// PNG or JPEG, told apart by content.
vm::Result<Image> DecodePicture(std::span<const std::uint8_t> bytes);

/// Whether a decoder may go on: 1..kMaxImageSide on each side. Error: kBadValue.
vm::Result<void> CheckSize(std::int64_t width, std::int64_t height);

}  // namespace fsm
