#include <csetjmp>
#include <cstddef>
#include <cstdio>
#include <cstdlib>

// This must follow the standard's headers, whose names it uses.
#include <jerror.h>
#include <jpeglib.h>

#include "fsm/image/image_codec.h"

namespace fsm {
namespace {

/// A progressive file with more scans is an attack, not a photo: each is a pass over all pixels.
constexpr int kMaxScans = 100;

struct Failure {
  jpeg_error_mgr manager;
  jpeg_progress_mgr progress;
  std::jmp_buf back;
  char text[JMSG_LENGTH_MAX];
  bool cut_off, torn, endless;
};

void JumpBack(j_common_ptr info) {
  auto* failure = reinterpret_cast<Failure*>(info->err);
  info->err->format_message(info, failure->text);
  std::longjmp(failure->back, 1);
}

/// Records libjpeg's warnings: after damage it continues and fills the rest with grey.
void RecordWarning(j_common_ptr info, int level) {
  if (level >= 0) return;
  auto* failure = reinterpret_cast<Failure*>(info->err);
  switch (info->err->msg_code) {
    case JWRN_JPEG_EOF:
      failure->cut_off = true;
      break;
    case JWRN_EXTRANEOUS_DATA:  // bytes between segments, as left by some cameras
    case JWRN_ADOBE_XFORM:
    case JWRN_JFIF_MAJOR:
    case JWRN_TOO_MUCH_DATA:
    case JWRN_BOGUS_ICC:
      break;
    default:
      failure->torn = true;
  }
}

void CountScans(j_common_ptr info) {
  const auto* decoder = reinterpret_cast<jpeg_decompress_struct*>(info);
  if (decoder->input_scan_number <= kMaxScans) return;
  auto* failure = reinterpret_cast<Failure*>(info->err);
  failure->endless = true;
  std::longjmp(failure->back, 1);
}

enum class Outcome { kDone, kDamaged, kTooLarge };

/// Only plain data may live here: on a damaged file longjmp skips destructors.
Outcome Decode(jpeg_decompress_struct& info, Failure& failure, std::span<const std::uint8_t> bytes,
               const JpegOptions& options, DecodedJpeg& decoded) {
  if (setjmp(failure.back)) return Outcome::kDamaged;
  jpeg_mem_src(&info, bytes.data(), bytes.size());
  jpeg_save_markers(&info, JPEG_APP0 + 1, 0xffff);
  jpeg_read_header(&info, TRUE);
  if (static_cast<std::int64_t>(info.image_width) * info.image_height > options.most_pixels) {
    return Outcome::kTooLarge;
  }
  for (const jpeg_marker_struct* m = info.marker_list; m; m = m->next) {
    decoded.exif.emplace_back(m->data, m->data + m->data_length);
  }
  const unsigned longer =
      info.image_width > info.image_height ? info.image_width : info.image_height;
  info.scale_num = 1;
  info.scale_denom = 1;
  while (options.enough_side > 0 && info.scale_denom < 8 &&
         longer / (2 * info.scale_denom) >= static_cast<unsigned>(options.enough_side)) {
    info.scale_denom *= 2;
  }
  const bool inked = info.jpeg_color_space == JCS_CMYK || info.jpeg_color_space == JCS_YCCK;
  // Adobe's files, which are nearly all files of this kind, store inverted inks.
  const bool inverted = info.saw_Adobe_marker;
  info.out_color_space = inked ? JCS_CMYK : JCS_RGB;
  jpeg_start_decompress(&info);
  Image& out = decoded.image;
  out.width = static_cast<int>(info.output_width);
  out.height = static_cast<int>(info.output_height);
  out.rgba.assign(static_cast<std::size_t>(out.width) * static_cast<std::size_t>(out.height) * 4,
                  255);
  const auto components = static_cast<std::size_t>(info.output_components);
  // libjpeg's own memory is freed with the decoder.
  JSAMPARRAY row =
      (*info.mem->alloc_sarray)(reinterpret_cast<j_common_ptr>(&info), JPOOL_IMAGE,
                                info.output_width * static_cast<JDIMENSION>(components), 1);
  while (info.output_scanline < info.output_height) {
    std::uint8_t* to = out.rgba.data() + static_cast<std::size_t>(info.output_scanline) *
                                             static_cast<std::size_t>(out.width) * 4;
    jpeg_read_scanlines(&info, row, 1);
    const std::uint8_t* from = row[0];
    const auto light = [inverted](std::uint8_t ink) { return inverted ? ink : 255 - ink; };
    for (int x = 0; x < out.width; ++x, from += components, to += 4) {
      for (std::size_t c = 0; c < 3; ++c) {
        to[c] = inked ? static_cast<std::uint8_t>(light(from[c]) * light(from[3]) / 255) : from[c];
      }
    }
  }
  jpeg_finish_decompress(&info);
  return Outcome::kDone;
}

/// Only plain data may live here, as in Decode. After success the caller frees `bytes`,
/// which libjpeg allocates.
bool Encode(jpeg_compress_struct& info, Failure& failure, const Image& image, int quality,
            unsigned char*& bytes, unsigned long& size) {
  if (setjmp(failure.back)) return false;
  jpeg_mem_dest(&info, &bytes, &size);
  info.image_width = static_cast<JDIMENSION>(image.width);
  info.image_height = static_cast<JDIMENSION>(image.height);
  info.input_components = 4;
  info.in_color_space = JCS_EXT_RGBX;
  jpeg_set_defaults(&info);
  jpeg_set_quality(&info, quality, TRUE);
  jpeg_start_compress(&info, TRUE);
  while (info.next_scanline < info.image_height) {
    const auto y = static_cast<int>(info.next_scanline);
    JSAMPROW row = const_cast<JSAMPROW>(&image.rgba[4 * image.Index(0, y)]);
    jpeg_write_scanlines(&info, &row, 1);
  }
  jpeg_finish_compress(&info);
  return true;
}

}  // namespace

std::vector<std::uint8_t> EncodeJpeg(const Image& image, int quality) {
  jpeg_compress_struct info{};
  Failure failure{};
  unsigned char* bytes = nullptr;
  unsigned long size = 0;
  info.err = jpeg_std_error(&failure.manager);
  failure.manager.error_exit = JumpBack;
  jpeg_create_compress(&info);
  std::vector<std::uint8_t> out;
  // Without memory to grow, `bytes` may be a buffer that libjpeg has freed; the one it has left is
  // lost.
  if (Encode(info, failure, image, quality, bytes, size)) {
    out.assign(bytes, bytes + size);
    std::free(bytes);
  }
  jpeg_destroy_compress(&info);
  return out;
}

vm::Result<DecodedJpeg> DecodeJpegAs(const JpegOptions& options,
                                     std::span<const std::uint8_t> bytes) {
  jpeg_decompress_struct info{};
  Failure failure{};
  info.err = jpeg_std_error(&failure.manager);
  failure.manager.error_exit = JumpBack;
  failure.manager.emit_message = RecordWarning;
  failure.progress.progress_monitor = CountScans;
  DecodedJpeg out;
  jpeg_create_decompress(&info);
  info.progress = &failure.progress;
  const Outcome outcome = Decode(info, failure, bytes, options, out);
  const std::string size =
      std::to_string(info.image_width) + " x " + std::to_string(info.image_height);
  jpeg_destroy_decompress(&info);
  std::string why;
  if (outcome == Outcome::kTooLarge) {
    why = "it has " + size + " pixels; at most " + std::to_string(options.most_pixels / 1'000'000) +
          " million are read: scale it down";
  } else if (failure.endless) {
    why = "it is built of more than " + std::to_string(kMaxScans) + " scans";
  } else if (failure.cut_off) {
    why = "the JPEG file is cut off: its end is missing";
  } else if (failure.torn) {
    why = "the JPEG file is damaged in the middle of the picture";
  } else if (outcome == Outcome::kDamaged) {
    why = std::string("the JPEG file is damaged: ") + failure.text;
  } else {
    return out;
  }
  return vm::Fail(vm::Errc::kBadValue, why);
}

vm::Result<Image> DecodeJpeg(std::span<const std::uint8_t> bytes) {
  auto decoded = DecodeJpegAs({}, bytes);
  if (!decoded) return std::unexpected(decoded.error());
  Image& image = decoded->image;
  if (auto fits = CheckSize(image.width, image.height); !fits) {
    return std::unexpected(fits.error());
  }
  return std::move(image);
}

}  // namespace fsm
