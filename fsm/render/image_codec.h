#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "fsm/render/renderer.h"

namespace fsm {

/// The formats of image_file.cc, each between bytes in memory and an Image. All decoders take
/// hostile bytes: an empty result means the file is damaged, too large or of a kind we do not read,
/// and `why` then says so in a clause.

std::vector<std::uint8_t> EncodePng(const Image& image);
std::vector<std::uint8_t> EncodeBmp(const Image& image);  ///< 24 bit, opacity dropped
std::vector<std::uint8_t> EncodeSgi(const Image& image);  ///< uncompressed RGB, opacity dropped

std::optional<Image> DecodePng(std::span<const std::uint8_t> bytes, std::string& why);
std::optional<Image> DecodeBmp(std::span<const std::uint8_t> bytes, std::string& why);
std::optional<Image> DecodeSgi(std::span<const std::uint8_t> bytes, std::string& why);

/// Whether a decoder may go on: 1..kMaxImageSide on each side.
bool SizeAllowed(std::int64_t width, std::int64_t height, std::string& why);
/// An image of that size, opaque black.
Image MakeBlack(int width, int height);

}  // namespace fsm
