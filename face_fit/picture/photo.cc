#include "face_fit/picture/photo.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <optional>
#include <system_error>
#include <utility>

#include "fsm/image/image_codec.h"

namespace facefit {
namespace {

constexpr std::uint8_t kPngStart[] = {0x89, 'P', 'N', 'G', 13, 10, 26, 10};
/// Below this nothing can be seen of a face.
constexpr int kLeastSide = 64;

bool StartsWith(std::span<const std::uint8_t> bytes, std::span<const std::uint8_t> start) {
  return bytes.size() >= start.size() && std::ranges::equal(bytes.first(start.size()), start);
}

/// Of several EXIF blocks the last that says something counts.
vm::Result<fsm::Image> DecodeJpegPhoto(std::span<const std::uint8_t> bytes, int most_side,
                                       int& orientation) {
  fsm::JpegWish wish{.most_pixels = kMaxPixels, .enough_side = most_side, .exif = {}};
  std::string why;
  auto image = fsm::DecodeJpeg(bytes, wish, why);
  if (!image) return vm::Fail(vm::Errc::kBadValue, why);
  for (const auto& block : wish.exif) {
    if (const int found = ExifOrientation(block); found != 1) orientation = found;
  }
  return std::move(*image);
}

vm::Result<fsm::Image> DecodePngPhoto(std::span<const std::uint8_t> bytes) {
  // Width and height stand in the first chunk; they are looked at before anything is decoded.
  if (bytes.size() < 24) return vm::Fail(vm::Errc::kBadValue, "the PNG file ends too early");
  const auto number = [&bytes](std::size_t at) {
    std::int64_t n = 0;
    for (std::size_t i = 0; i < 4; ++i) n = n << 8 | bytes[at + i];
    return n;
  };
  const std::int64_t width = number(16), height = number(20);
  if (width > kMaxPixels || height > kMaxPixels || width * height > kMaxPixels) {
    return vm::Fail(vm::Errc::kBadValue, "the photo has " + std::to_string(width) + " x " +
                                             std::to_string(height) + " pixels; at most " +
                                             std::to_string(kMaxPixels / 1'000'000) +
                                             " million are read: scale it down");
  }
  std::string why;
  auto image = fsm::DecodePng(bytes, why);
  if (!image) return vm::Fail(vm::Errc::kBadValue, "the PNG file cannot be read: " + why);
  // What is transparent lies before white.
  for (std::size_t i = 0; i < image->rgba.size(); i += 4) {
    const unsigned a = image->rgba[i + 3];
    for (std::size_t c = 0; c < 3; ++c) {
      image->rgba[i + c] =
          static_cast<std::uint8_t>((image->rgba[i + c] * a + 255U * (255U - a) + 127U) / 255U);
    }
    image->rgba[i + 3] = 255;
  }
  return std::move(*image);
}

/// Nothing if it is no larger.
std::optional<fsm::Image> ScaledTo(int most_side, const fsm::Image& image) {
  const int longer = std::max(image.width, image.height);
  if (longer <= most_side) return std::nullopt;
  const auto scaled = [&](int side) {
    return std::max(static_cast<int>(std::lround(static_cast<double>(side) * most_side / longer)),
                    1);
  };
  return ScaledDown(image, scaled(image.width), scaled(image.height));
}

}  // namespace

fsm::Image AtWorkingSide(const fsm::Image& photo) {
  auto scaled = ScaledTo(kWorkingSide, photo);
  return scaled ? std::move(*scaled) : photo;
}

vm::Result<fsm::Image> DecodePhoto(std::span<const std::uint8_t> bytes, int most_side) {
  constexpr std::uint8_t kJpegStart[] = {0xff, 0xd8, 0xff};
  int orientation = 1;
  vm::Result<fsm::Image> image =
      StartsWith(bytes, kJpegStart)  ? DecodeJpegPhoto(bytes, most_side, orientation)
      : StartsWith(bytes, kPngStart) ? DecodePngPhoto(bytes)
                                     : vm::Fail(vm::Errc::kBadValue,
                                                "not a picture that is read here: a JPEG or PNG "
                                                "file is expected");
  if (!image) return image;
  if (std::min(image->width, image->height) < kLeastSide) {
    return vm::Fail(vm::Errc::kBadValue, "the photo is only " + std::to_string(image->width) +
                                             " x " + std::to_string(image->height) +
                                             " pixels; at least " + std::to_string(kLeastSide) +
                                             " on each side are needed");
  }
  if (auto scaled = ScaledTo(most_side, *image)) *image = std::move(*scaled);
  if (orientation != 1) *image = Turned(*image, orientation);
  return image;
}

vm::Result<fsm::Image> ReadPhoto(const std::string& path, int most_side) {
  std::error_code error;
  const auto bytes = std::filesystem::file_size(path, error);
  if (error) {
    return vm::Fail(vm::Errc::kUnavailable, "cannot read '" + path + "': " + error.message());
  }
  if (bytes > 200'000'000) {
    return vm::Fail(vm::Errc::kBadValue, "'" + path + "' is larger than 200 MB, no photo is");
  }
  std::vector<std::uint8_t> data(bytes);
  std::ifstream file(path, std::ios::binary);
  if (!file.read(reinterpret_cast<char*>(data.data()), static_cast<std::streamsize>(bytes))) {
    return vm::Fail(vm::Errc::kUnavailable, "cannot read '" + path + "'");
  }
  auto image = DecodePhoto(data, most_side);
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
    std::uint32_t n = 0;
    for (std::size_t i = 0; i < bytes; ++i) {
      n |= static_cast<std::uint32_t>(tiff[at + i]) << 8 * (little ? i : bytes - 1 - i);
    }
    return n;
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

fsm::Image Turned(const fsm::Image& image, int exif_orientation) {
  const bool swaps = exif_orientation >= 5;
  fsm::Image out;
  out.width = swaps ? image.height : image.width;
  out.height = swaps ? image.width : image.height;
  out.rgba.resize(image.rgba.size());
  for (int y = 0; y < out.height; ++y) {
    for (int x = 0; x < out.width; ++x) {
      int from_x = swaps ? y : x;
      int from_y = swaps ? x : y;
      // 2 and 3 and 7 and 8 run from right to left, 3 and 4 and 6 and 7 from below.
      const int o = exif_orientation;
      if (o == 2 || o == 3 || o == 7 || o == 8) from_x = image.width - 1 - from_x;
      if (o == 3 || o == 4 || o == 6 || o == 7) from_y = image.height - 1 - from_y;
      std::memcpy(
          &out.rgba[4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(out.width) +
                         static_cast<std::size_t>(x))],
          &image
               .rgba[4 * (static_cast<std::size_t>(from_y) * static_cast<std::size_t>(image.width) +
                          static_cast<std::size_t>(from_x))],
          4);
    }
  }
  return out;
}

fsm::Image ScaledDown(const fsm::Image& image, int width, int height) {
  // First across, then down; weights are the lengths by which pixels overlap.
  const auto each = [](double ratio, int k, int from, auto&& add) {
    const double begin = k * ratio, end = (k + 1) * ratio;
    for (int i = static_cast<int>(begin); i < from && i < end; ++i) {
      add(i, std::min<double>(i + 1, end) - std::max<double>(i, begin));
    }
  };
  const double across = static_cast<double>(image.width) / width;
  const double down = static_cast<double>(image.height) / height;
  const auto row_size = static_cast<std::size_t>(width) * 3;
  std::vector<float> row(row_size);
  int shrunk = -1;  // which line of the picture `row` is
  const auto shrink = [&](int line) {
    const std::uint8_t* from =
        &image.rgba[static_cast<std::size_t>(line) * 4 * static_cast<std::size_t>(image.width)];
    for (int x = 0; x < width; ++x) {
      double sum[3] = {};
      each(across, x, image.width, [&](int i, double weight) {
        for (int c = 0; c < 3; ++c) sum[c] += weight * from[4 * i + c];
      });
      for (int c = 0; c < 3; ++c)
        row[static_cast<std::size_t>(3 * x + c)] = static_cast<float>(sum[c] / across);
    }
    shrunk = line;
  };
  fsm::Image out;
  out.width = width;
  out.height = height;
  out.rgba.reserve(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 4);
  std::vector<double> sum(row_size);
  for (int y = 0; y < height; ++y) {
    std::ranges::fill(sum, 0);
    each(down, y, image.height, [&](int i, double weight) {
      if (i != shrunk) shrink(i);  // a line on the border counts for two
      for (std::size_t k = 0; k < row_size; ++k) sum[k] += weight * static_cast<double>(row[k]);
    });
    for (std::size_t k = 0; k < row_size; ++k) {
      const auto v = static_cast<float>(sum[k] / down);
      out.rgba.push_back(static_cast<std::uint8_t>(std::clamp(v + 0.5F, 0.0F, 255.0F)));
      if (k % 3 == 2) out.rgba.push_back(255);
    }
  }
  return out;
}

glm::vec3 ColourAt(const fsm::Image& image, glm::vec2 at) {
  const float x = std::clamp(at.x - 0.5F, 0.0F, static_cast<float>(image.width - 1));
  const float y = std::clamp(at.y - 0.5F, 0.0F, static_cast<float>(image.height - 1));
  const int x0 = static_cast<int>(x), y0 = static_cast<int>(y);
  const int x1 = std::min(x0 + 1, image.width - 1), y1 = std::min(y0 + 1, image.height - 1);
  const float u = x - static_cast<float>(x0), v = y - static_cast<float>(y0);
  const auto pixel = [&image](int px, int py) {
    const std::uint8_t* p =
        &image.rgba[4 * (static_cast<std::size_t>(py) * static_cast<std::size_t>(image.width) +
                         static_cast<std::size_t>(px))];
    return glm::vec3(p[0], p[1], p[2]);
  };
  return (pixel(x0, y0) * (1 - u) + pixel(x1, y0) * u) * (1 - v) +
         (pixel(x0, y1) * (1 - u) + pixel(x1, y1) * u) * v;
}

}  // namespace facefit
