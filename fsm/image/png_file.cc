#include <png.h>

#include <cstring>
#include <new>

#include "fsm/image/image_codec.h"

namespace fsm {
namespace {

void AppendBytes(png_structp png, png_bytep data, std::size_t size) {
  auto* out = static_cast<std::vector<std::uint8_t>*>(png_get_io_ptr(png));
  out->insert(out->end(), data, data + size);
}

}  // namespace

std::vector<std::uint8_t> EncodePng(const Image& image) {
  // Only a lack of memory can fail here; libpng's default handler would then abort the program, as
  // any lack of memory does.
  std::vector<std::uint8_t> out;
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png ? png_create_info_struct(png) : nullptr;
  if (!info) throw std::bad_alloc();
  png_set_write_fn(png, &out, AppendBytes, nullptr);
  png_set_IHDR(png, info, static_cast<png_uint_32>(image.width),
               static_cast<png_uint_32>(image.height), 8, PNG_COLOR_TYPE_RGBA, PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  // Pictures are taken while the face moves: files are slightly larger, encoding much faster.
  png_set_compression_level(png, 3);
  png_set_filter(png, 0, PNG_FILTER_SUB | PNG_FILTER_UP);
  png_set_sRGB(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
  png_write_info(png, info);
  const auto stride = static_cast<std::size_t>(image.width) * 4;
  for (std::size_t row = 0; row < static_cast<std::size_t>(image.height); ++row) {
    png_write_row(png, image.rgba.data() + row * stride);
  }
  png_write_end(png, nullptr);
  png_destroy_write_struct(&png, &info);
  return out;
}

vm::Result<Image> DecodePng(std::span<const std::uint8_t> bytes) {
  // The simplified interface keeps longjmp inside libpng.
  png_image header;
  std::memset(&header, 0, sizeof header);
  header.version = PNG_IMAGE_VERSION;
  if (!png_image_begin_read_from_memory(&header, bytes.data(), bytes.size())) {
    return vm::Fail(vm::Errc::kBadValue, header.message);
  }
  if (auto fits = CheckSize(header.width, header.height); !fits) {
    png_image_free(&header);
    return std::unexpected(fits.error());
  }
  header.format = PNG_FORMAT_RGBA;
  Image image =
      FilledImage(static_cast<int>(header.width), static_cast<int>(header.height), kBlack);
  if (!png_image_finish_read(&header, nullptr, image.rgba.data(), 0, nullptr)) {
    png_image_free(&header);  // keeps the message
    return vm::Fail(vm::Errc::kBadValue, header.message);
  }
  return image;
}

}  // namespace fsm
