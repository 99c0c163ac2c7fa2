#include "fsm/render/gl_objects.h"

#include <algorithm>
#include <stdexcept>

namespace fsm {
namespace {

/// Returns the log of a shader or program, through its two differently named pairs of getters.
template <typename GetNumber, typename GetText>
std::string InfoLog(GLuint object, GetNumber get_number, GetText get_text) {
  GLint length = 0;
  get_number(object, GL_INFO_LOG_LENGTH, &length);
  std::string text(static_cast<std::size_t>(length), '\0');
  if (length > 0) get_text(object, length, nullptr, text.data());
  return text;
}

GLuint Compile(const GlFunctions& gl, const char* name, GLenum kind, std::string_view source) {
  const GLuint shader = gl.CreateShader(kind);
  const char* text = source.data();
  const auto length = static_cast<GLint>(source.size());
  gl.ShaderSource(shader, 1, &text, &length);
  gl.CompileShader(shader);
  GLint compiled = 0;
  gl.GetShaderiv(shader, GL_COMPILE_STATUS, &compiled);
  if (!compiled) {
    const std::string log = InfoLog(shader, gl.GetShaderiv, gl.GetShaderInfoLog);
    gl.DeleteShader(shader);
    throw std::runtime_error(std::string("shader ") + name + " does not compile: " + log);
  }
  return shader;
}

}  // namespace

GlProgram::GlProgram(const GlFunctions& gl, const char* name, std::string_view vertex,
                     std::string_view fragment)
    : gl_(gl), id_(0) {
  const GLuint vertex_shader = Compile(gl, name, GL_VERTEX_SHADER, vertex);
  GLuint fragment_shader = 0;
  try {
    fragment_shader = Compile(gl, name, GL_FRAGMENT_SHADER, fragment);
  } catch (...) {
    gl.DeleteShader(vertex_shader);
    throw;
  }
  Link(name, {vertex_shader, fragment_shader});
}

GlProgram::GlProgram(const GlFunctions& gl, const char* name, std::string_view compute)
    : gl_(gl), id_(0) {
  Link(name, {Compile(gl, name, GL_COMPUTE_SHADER, compute)});
}

void GlProgram::Link(const char* name, std::initializer_list<GLuint> shaders) {
  id_ = gl_.CreateProgram();
  for (const GLuint shader : shaders) gl_.AttachShader(id_, shader);
  gl_.LinkProgram(id_);
  for (const GLuint shader : shaders) gl_.DeleteShader(shader);
  GLint linked = 0;
  gl_.GetProgramiv(id_, GL_LINK_STATUS, &linked);
  if (!linked) {
    const std::string log = InfoLog(id_, gl_.GetProgramiv, gl_.GetProgramInfoLog);
    gl_.DeleteProgram(id_);
    throw std::runtime_error(std::string("shader ") + name + " does not link: " + log);
  }
}

std::optional<GLint> GlProgram::Changed(const char* name, std::span<const std::byte> value) const {
  const auto [found, is_new] = uniforms_.try_emplace(name);
  Uniform& uniform = found->second;
  if (is_new) uniform.location = gl_.GetUniformLocation(id_, name);
  if (uniform.location < 0 || std::ranges::equal(uniform.value, value)) return {};
  uniform.value.assign(value.begin(), value.end());
  return uniform.location;
}

GlFramebuffer::GlFramebuffer(const GlFunctions& gl, int width, int height)
    : gl_(gl), width_(width), height_(height) {
  const int across = width * kSamplesAlong, up = height * kSamplesAlong;
  gl.GenFramebuffers(1, &frame_);
  gl.BindFramebuffer(GL_FRAMEBUFFER, frame_);
  gl.GenTextures(1, &colour_);
  gl.ActiveTexture(GlUnit(TextureUnit::kPass));
  gl.BindTexture(GL_TEXTURE_2D, colour_);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  gl.TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, across, up, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
  gl.FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, colour_, 0);
  // The rasterizer computes depth as floating point, so this format needs no conversion.
  gl.GenRenderbuffers(1, &depth_);
  gl.BindRenderbuffer(GL_RENDERBUFFER, depth_);
  gl.RenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH_COMPONENT32F, across, up);
  gl.FramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, depth_);
  if (gl.CheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
    Delete();
    throw std::runtime_error("OpenGL cannot make a picture of " + std::to_string(width) + " x " +
                             std::to_string(height) + " with 4 samples");
  }
}

void GlFramebuffer::Delete() {
  gl_.DeleteFramebuffers(1, &frame_);
  gl_.DeleteTextures(1, &colour_);
  gl_.DeleteRenderbuffers(1, &depth_);
}

void GlFramebuffer::Bind() const {
  gl_.BindFramebuffer(GL_FRAMEBUFFER, frame_);
  gl_.Viewport(0, 0, width_ * kSamplesAlong, height_ * kSamplesAlong);
}

void GlFramebuffer::ReadRows(int from, int to, void* samples) const {
  gl_.BindFramebuffer(GL_READ_FRAMEBUFFER, frame_);
  gl_.PixelStorei(GL_PACK_ALIGNMENT, 1);
  gl_.ReadPixels(0, from, width_ * kSamplesAlong, to - from + 1, GL_RGBA, GL_UNSIGNED_BYTE,
                 samples);
}

void GlFramebuffer::Read(Image& out, Filter filter) {
  // Reads few rows at a time, so that they stay in the cache until they are averaged.
  constexpr int kRowsAtOnce = 16;
  const std::size_t row = samples_in_row();
  out.width = width_;
  out.height = height_;
  out.rgba.resize(row * 2 * static_cast<std::size_t>(height_));
  std::uint8_t* rgba = out.rgba.data();
  samples_.resize(row * (kRowsAtOnce * kSamplesAlong + 2));
  for (int y = height_; y > 0; y -= kRowsAtOnce) {
    // GL's first row is the lowest.
    const int first = std::max(y - kRowsAtOnce, 0);
    const int beside = filter == Filter::kSoft ? 1 : 0;
    const int from = std::max(first * kSamplesAlong - beside, 0);
    const int to = std::min(y * kSamplesAlong - 1 + beside, height_ * kSamplesAlong - 1);
    ReadRows(from, to, samples_.data());
    AverageSamples({samples_.data(), row, from, to}, first, y - first, filter, rgba);
    rgba += row * 2 * static_cast<std::size_t>(y - first);
  }
}

void GlFramebuffer::Show(int x, int y) const {
  gl_.BindFramebuffer(GL_READ_FRAMEBUFFER, frame_);
  // A linear filter at half size averages exactly four samples.
  gl_.BlitFramebuffer(0, 0, width_ * kSamplesAlong, height_ * kSamplesAlong, x, y, x + width_,
                      y + height_, GL_COLOR_BUFFER_BIT, GL_LINEAR);
}

}  // namespace fsm
