#include "face_fit/picture/jpeg_file.h"

#include <jpeglib.h>

#include <csetjmp>
#include <cstddef>
#include <cstdio>

namespace facefit {
namespace {

struct Failure {
  jpeg_error_mgr manager;
  std::jmp_buf back;
  char text[JMSG_LENGTH_MAX];
};

void Fail(j_common_ptr info) {
  auto* failure = reinterpret_cast<Failure*>(info->err);
  info->err->format_message(info, failure->text);
  std::longjmp(failure->back, 1);
}

void Quiet(j_common_ptr) {}

enum class Outcome { kDone, kDamaged, kTooLarge };

/// Only plain data lives here: a damaged file leaves by a long jump, past destructors.
Outcome Decode(jpeg_decompress_struct& info, Failure& failure, std::span<const std::uint8_t> bytes,
               fsm::Image& out, int& orientation) {
  if (setjmp(failure.back)) return Outcome::kDamaged;
  jpeg_mem_src(&info, bytes.data(), bytes.size());
  jpeg_save_markers(&info, JPEG_APP0 + 1, 0xffff);
  jpeg_read_header(&info, TRUE);
  if (static_cast<std::int64_t>(info.image_width) * info.image_height > kMaxPixels) {
    return Outcome::kTooLarge;
  }
  for (const jpeg_marker_struct* m = info.marker_list; m; m = m->next) {
    const int found = ExifOrientation({m->data, m->data_length});
    if (found != 1) orientation = found;
  }
  const unsigned longer =
      info.image_width > info.image_height ? info.image_width : info.image_height;
  info.scale_num = 1;
  info.scale_denom = 1;
  while (info.scale_denom < 8 && longer / (2 * info.scale_denom) >= kWorkingSide) {
    info.scale_denom *= 2;
  }
  const bool inked = info.jpeg_color_space == JCS_CMYK || info.jpeg_color_space == JCS_YCCK;
  info.out_color_space = inked ? JCS_CMYK : JCS_RGB;
  jpeg_start_decompress(&info);
  out.width = static_cast<int>(info.output_width);
  out.height = static_cast<int>(info.output_height);
  out.rgba.assign(static_cast<std::size_t>(out.width) * static_cast<std::size_t>(out.height) * 4,
                  255);
  const auto components = static_cast<std::size_t>(info.output_components);
  // libjpeg's own memory, so that it goes with the decoder.
  JSAMPARRAY row =
      (*info.mem->alloc_sarray)(reinterpret_cast<j_common_ptr>(&info), JPOOL_IMAGE,
                                info.output_width * static_cast<JDIMENSION>(components), 1);
  while (info.output_scanline < info.output_height) {
    std::uint8_t* to = out.rgba.data() + static_cast<std::size_t>(info.output_scanline) *
                                             static_cast<std::size_t>(out.width) * 4;
    jpeg_read_scanlines(&info, row, 1);
    const std::uint8_t* from = row[0];
    for (int x = 0; x < out.width; ++x, from += components, to += 4) {
      for (std::size_t c = 0; c < 3; ++c) {
        // Adobe's files hold inks inverted, which is what nearly all files of this kind are.
        to[c] = inked ? static_cast<std::uint8_t>(from[c] * from[3] / 255) : from[c];
      }
    }
  }
  jpeg_finish_decompress(&info);
  return Outcome::kDone;
}

}  // namespace

vm::Result<fsm::Image> DecodeJpeg(std::span<const std::uint8_t> bytes, int& orientation) {
  jpeg_decompress_struct info{};
  Failure failure{};
  info.err = jpeg_std_error(&failure.manager);
  failure.manager.error_exit = Fail;
  failure.manager.output_message = Quiet;
  fsm::Image out;
  orientation = 1;
  jpeg_create_decompress(&info);
  const Outcome outcome = Decode(info, failure, bytes, out, orientation);
  const std::string size =
      std::to_string(info.image_width) + " x " + std::to_string(info.image_height);
  jpeg_destroy_decompress(&info);
  switch (outcome) {
    case Outcome::kDone:
      return out;
    case Outcome::kTooLarge:
      return vm::Fail(vm::Errc::kBadValue, "the photo has " + size + " pixels; at most " +
                                               std::to_string(kMaxPixels / 1'000'000) +
                                               " million are read: scale it down");
    case Outcome::kDamaged:
      break;
  }
  return vm::Fail(vm::Errc::kBadValue, std::string("the JPEG file is damaged: ") + failure.text);
}

}  // namespace facefit
