#include "fsm/image/byte_order.h"
#include "fsm/image/image_codec.h"

namespace fsm {
namespace {

// SGI images (Haeberli, "The SGI Image File Format", version 1.00): a 512-byte header, big-endian
// numbers, then the channels one after the other, each from the lowest row up. Run-length encoded
// files have tables of each row's start and length after the header.
constexpr std::size_t kHeader = 512;
constexpr std::uint32_t kMagic = 474;

struct Header {
  bool packed;
  std::size_t width, height, channels;
};

vm::Result<Header> ReadHeader(std::span<const std::uint8_t> bytes) {
  if (bytes.size() < kHeader || BigEndian(bytes, 0, 2) != kMagic) {
    return vm::Fail(vm::Errc::kBadValue, "it is not an SGI image");
  }
  const auto dimension = BigEndian(bytes, 4, 2);
  if (bytes[2] > 1 || bytes[3] != 1 || dimension < 2 || dimension > 3 ||
      BigEndian(bytes, 104, 4) != 0) {
    return vm::Fail(vm::Errc::kBadValue, "only SGI images of one byte per channel are read");
  }
  Header header{bytes[2] == 1, BigEndian(bytes, 6, 2), BigEndian(bytes, 8, 2),
                dimension == 2 ? 1 : BigEndian(bytes, 10, 2)};
  if (auto fits = CheckSize(static_cast<std::int64_t>(header.width),
                            static_cast<std::int64_t>(header.height));
      !fits) {
    return std::unexpected(fits.error());
  }
  if (header.channels < 1 || header.channels > 4) {
    return vm::Fail(vm::Errc::kBadValue, "it has " + std::to_string(header.channels) + " channels");
  }
  return header;
}

/// Unpacks one row; returns false if the packed bytes are not exactly one row.
bool UnpackRow(std::span<const std::uint8_t> packed, std::span<std::uint8_t> row) {
  std::size_t at = 0;
  std::size_t filled = 0;
  while (at < packed.size()) {
    const std::size_t count = packed[at] & 0x7f;
    const bool literal = (packed[at++] & 0x80) != 0;
    if (count == 0) break;
    if (count > row.size() - filled || (literal ? count : 1) > packed.size() - at) return false;
    for (std::size_t i = 0; i < count; ++i) row[filled++] = packed[literal ? at + i : at];
    at += literal ? count : 1;
  }
  return filled == row.size();
}

bool ReadRow(std::span<const std::uint8_t> bytes, const Header& header, std::size_t index,
             std::span<std::uint8_t> row) {
  if (!header.packed) {
    const std::size_t start = kHeader + index * header.width;
    if (start + header.width > bytes.size()) return false;
    for (std::size_t x = 0; x < header.width; ++x) row[x] = bytes[start + x];
    return true;
  }
  const std::size_t rows = header.height * header.channels;
  if (kHeader + rows * 8 > bytes.size()) return false;
  const std::size_t start = BigEndian(bytes, kHeader + index * 4, 4);
  const std::size_t length = BigEndian(bytes, kHeader + (rows + index) * 4, 4);
  if (start > bytes.size() || length > bytes.size() - start) return false;
  return UnpackRow(bytes.subspan(start, length), row);
}

}  // namespace

std::vector<std::uint8_t> EncodeSgi(const Image& image) {
  const auto width = static_cast<std::size_t>(image.width);
  const auto height = static_cast<std::size_t>(image.height);
  std::vector<std::uint8_t> out;
  out.reserve(kHeader + width * height * 3);
  AppendBigEndian(out, kMagic, 2);
  out.push_back(0);  // not packed
  out.push_back(1);  // one byte per channel
  AppendBigEndian(out, 3, 2);
  AppendBigEndian(out, static_cast<std::uint32_t>(width), 2);
  AppendBigEndian(out, static_cast<std::uint32_t>(height), 2);
  AppendBigEndian(out, 3, 2);
  AppendBigEndian(out, 0, 4);
  AppendBigEndian(out, 255, 4);
  out.resize(kHeader, 0);
  for (std::size_t channel = 0; channel < 3; ++channel) {
    for (std::size_t y = height; y-- > 0;) {
      for (std::size_t x = 0; x < width; ++x) {
        out.push_back(image.rgba[(y * width + x) * 4 + channel]);
      }
    }
  }
  return out;
}

vm::Result<Image> DecodeSgi(std::span<const std::uint8_t> bytes) {
  const auto header = ReadHeader(bytes);
  if (!header) return std::unexpected(header.error());
  Image image =
      FilledImage(static_cast<int>(header->width), static_cast<int>(header->height), kBlack);
  std::vector<std::uint8_t> row(header->width);
  for (std::size_t channel = 0; channel < header->channels; ++channel) {
    for (std::size_t y = 0; y < header->height; ++y) {
      if (!ReadRow(bytes, *header, channel * header->height + y, row)) {
        return vm::Fail(vm::Errc::kBadValue, "it ends too early or its packing is damaged");
      }
      auto* line = &image.rgba[(header->height - 1 - y) * header->width * 4];
      // A single channel is grey; a second one is alpha.
      const bool grey = header->channels < 3;
      for (std::size_t x = 0; x < header->width; ++x) {
        auto* pixel = line + x * 4;
        if (!grey) {
          pixel[channel] = row[x];
        } else if (channel == 0) {
          pixel[0] = pixel[1] = pixel[2] = row[x];
        } else {
          pixel[3] = row[x];
        }
      }
    }
  }
  return image;
}

}  // namespace fsm
