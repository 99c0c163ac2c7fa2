#include "fsm/render/frame_reader.h"

#include <cassert>
#include <cstring>
#include <stdexcept>
#include <utility>

#include "embedded/average_samples.h"

namespace fsm {
namespace {

GLsizeiptr BytesOf(const Image& image) {
  return static_cast<GLsizeiptr>(image.width) * image.height * 4;
}

}  // namespace

FrameReader::FrameReader(const GlFunctions& gl, bool on_gpu) : gl_(gl) {
  if (on_gpu) average_.emplace(gl, "average_samples", embedded::average_samples());
}

FrameReader::~FrameReader() {
  for (const auto& [number, frame] : frames_) spare_buffers_.push_back(frame.buffer);
  for (const Buffer& buffer : spare_buffers_) gl_.DeleteBuffers(1, &buffer.name);
}

std::uint64_t FrameReader::Begin(GlFramebuffer& framebuffer, const ReadOptions& options) {
  Frame& frame = frames_[++last_];
  frame.transparent = options.transparent;
  if (average_) {
    BeginAverage(framebuffer, options.filter, frame);
  } else {
    framebuffer.Read(frame.image, options.filter);
  }
  return last_;
}

void FrameReader::End(std::uint64_t number, Image& out) {
  auto found = frames_.extract(number);
  assert(!found.empty());
  Frame& frame = found.mapped();
  if (frame.buffer.name != 0) {
    EndAverage(frame, out);
  } else {
    out = std::move(frame.image);
  }
  if (frame.transparent) Unmultiply(out);
}

void FrameReader::Drop(std::uint64_t number) {
  const auto found = frames_.extract(number);
  if (!found.empty() && found.mapped().buffer.name != 0) {
    spare_buffers_.push_back(found.mapped().buffer);
  }
}

void FrameReader::BeginAverage(const GlFramebuffer& framebuffer, Filter filter, Frame& frame) {
  Image& image = frame.image;
  image.width = framebuffer.width();
  image.height = framebuffer.height();
  Buffer& buffer = frame.buffer;
  if (spare_buffers_.empty()) {
    gl_.GenBuffers(1, &buffer.name);
  } else {
    buffer = spare_buffers_.back();
    spare_buffers_.pop_back();
  }
  gl_.BindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, buffer.name);
  if (std::exchange(buffer.bytes, BytesOf(image)) != BytesOf(image)) {
    gl_.BufferData(GL_SHADER_STORAGE_BUFFER, buffer.bytes, nullptr, GL_STREAM_READ);
  }
  gl_.ActiveTexture(GlUnit(TextureUnit::kPass));
  gl_.BindTexture(GL_TEXTURE_2D, framebuffer.samples());
  average_->Use();
  average_->Set("samples", TextureUnit::kPass);
  average_->Set("soft", filter == Filter::kSoft);
  constexpr int kGroup = 8;  // local_size_x and _y
  gl_.DispatchCompute(static_cast<GLuint>((image.width + kGroup - 1) / kGroup),
                      static_cast<GLuint>((image.height + kGroup - 1) / kGroup), 1);
  gl_.MemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  gl_.Flush();
}

void FrameReader::EndAverage(const Frame& frame, Image& out) {
  const Buffer& buffer = frame.buffer;
  out.width = frame.image.width;
  out.height = frame.image.height;
  out.rgba.resize(static_cast<std::size_t>(buffer.bytes));
  gl_.BindBuffer(GL_SHADER_STORAGE_BUFFER, buffer.name);
  const void* pixels =
      gl_.MapBufferRange(GL_SHADER_STORAGE_BUFFER, 0, buffer.bytes, GL_MAP_READ_BIT);
  if (pixels) {
    std::memcpy(out.rgba.data(), pixels, out.rgba.size());
    gl_.UnmapBuffer(GL_SHADER_STORAGE_BUFFER);
  }
  spare_buffers_.push_back(buffer);
  if (!pixels) throw std::runtime_error("OpenGL does not hand out a frame that was drawn");
}

}  // namespace fsm
