#include "fsm/render/frame_reader.h"

#include <cassert>
#include <stdexcept>
#include <utility>

namespace fsm {

FrameReader::~FrameReader() {
  for (const auto& [number, frame] : frames_) {
    if (frame.buffer != 0) spare_buffers_.push_back(frame.buffer);
  }
  for (const GLuint buffer : spare_buffers_) gl_.DeleteBuffers(1, &buffer);
}

std::uint64_t FrameReader::Begin(GlTarget& target, bool soft, bool transparent) {
  Frame& frame = frames_[++last_];
  frame.soft = soft;
  frame.transparent = transparent;
  if (by_buffers_) {
    BeginCopy(target, frame);
  } else {
    target.Read(frame.image, soft);
  }
  return last_;
}

void FrameReader::End(std::uint64_t number, Image& out) {
  auto found = frames_.extract(number);
  assert(!found.empty());
  Frame& frame = found.mapped();
  if (frame.buffer != 0) EndCopy(frame);
  if (frame.transparent) Unmultiply(frame.image);
  out = std::move(frame.image);
}

void FrameReader::Drop(std::uint64_t number) {
  const auto found = frames_.extract(number);
  if (!found.empty() && found.mapped().buffer != 0) {
    spare_buffers_.push_back(found.mapped().buffer);
  }
}

void FrameReader::BeginCopy(const GlTarget& target, Frame& frame) {
  if (spare_buffers_.empty()) {
    gl_.GenBuffers(1, &frame.buffer);
  } else {
    frame.buffer = spare_buffers_.back();
    spare_buffers_.pop_back();
  }
  frame.image.width = target.width();
  frame.image.height = target.height();
  const int rows = target.height() * kSamplesAlong;
  gl_.BindBuffer(GL_PIXEL_PACK_BUFFER, frame.buffer);
  gl_.BufferData(GL_PIXEL_PACK_BUFFER, static_cast<GLsizeiptr>(target.samples_in_row() * 4) * rows,
                 nullptr, GL_STREAM_READ);
  target.ReadRows(0, rows - 1, nullptr);
  gl_.BindBuffer(GL_PIXEL_PACK_BUFFER, 0);
  gl_.Flush();
}

void FrameReader::EndCopy(Frame& frame) {
  Image& image = frame.image;
  const std::size_t row = static_cast<std::size_t>(image.width) * kSamplesAlong;
  const int rows = image.height * kSamplesAlong;
  image.rgba.resize(row * 2 * static_cast<std::size_t>(image.height));
  gl_.BindBuffer(GL_PIXEL_PACK_BUFFER, frame.buffer);
  const void* samples = gl_.MapBufferRange(
      GL_PIXEL_PACK_BUFFER, 0, static_cast<GLsizeiptr>(row * 4) * rows, GL_MAP_READ_BIT);
  if (samples) {
    AverageSamples({static_cast<const std::uint32_t*>(samples), row, 0, rows - 1}, 0, image.height,
                   frame.soft, image.rgba.data());
    gl_.UnmapBuffer(GL_PIXEL_PACK_BUFFER);
  }
  gl_.BindBuffer(GL_PIXEL_PACK_BUFFER, 0);
  spare_buffers_.push_back(frame.buffer);
  if (!samples) throw std::runtime_error("OpenGL does not hand out a frame that was drawn");
}

}  // namespace fsm
