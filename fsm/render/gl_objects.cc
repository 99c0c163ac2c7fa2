#include "fsm/render/gl_objects.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <stdexcept>

namespace fsm {
namespace {

/// Samples along each side of a pixel.
constexpr int kSide = 2;

/// The average of every 2 x 2 of two rows of samples that follow each other, rounded to the
/// nearest. Bytes 0 and 2 of a sample are added in one word, 1 and 3 in another, with room for the
/// carry.
void AverageRow(const std::uint32_t* samples, std::size_t row, std::uint8_t* rgba) {
  constexpr std::uint32_t kEven = 0x00ff00ff;
  constexpr std::uint32_t kHalf = 0x00020002;
  for (std::size_t x = 0; x < row; x += 2) {
    const std::uint32_t four[] = {samples[x], samples[x + 1], samples[row + x],
                                  samples[row + x + 1]};
    std::uint32_t even = kHalf, odd = kHalf;
    for (const std::uint32_t sample : four) {
      even += sample & kEven;
      odd += (sample >> 8) & kEven;
    }
    const std::uint32_t average = ((even >> 2) & kEven) | (((odd >> 2) & kEven) << 8);
    std::memcpy(rgba + 2 * x, &average, sizeof(average));
  }
}

/// Likewise of every 4 x 4 of four rows, the inner samples three times as heavy as the outer ones
/// in either direction: pixels share what lies between them. `sums`: room for 2 * row words.
void SoftRow(const std::array<const std::uint32_t*, 4>& rows, std::size_t row, std::uint32_t* sums,
             std::uint8_t* rgba) {
  constexpr std::uint32_t kEven = 0x00ff00ff;
  constexpr std::uint32_t kHalf = 0x00200020;
  std::uint32_t* even = sums;
  std::uint32_t* odd = sums + row;
  const auto weigh = [](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    return a + d + 3 * (b + c);  // up to 8 times a byte, then 64 times: 16 bits hold it
  };
  for (std::size_t x = 0; x < row; ++x) {
    const std::uint32_t s[] = {rows[0][x], rows[1][x], rows[2][x], rows[3][x]};
    even[x] = weigh(s[0] & kEven, s[1] & kEven, s[2] & kEven, s[3] & kEven);
    odd[x] =
        weigh((s[0] >> 8) & kEven, (s[1] >> 8) & kEven, (s[2] >> 8) & kEven, (s[3] >> 8) & kEven);
  }
  for (std::size_t x = 0; x < row; x += 2) {
    const std::size_t before = x > 0 ? x - 1 : x, after = std::min(x + 2, row - 1);
    const std::uint32_t e = weigh(even[before], even[x], even[x + 1], even[after]) + kHalf;
    const std::uint32_t o = weigh(odd[before], odd[x], odd[x + 1], odd[after]) + kHalf;
    const std::uint32_t average = ((e >> 6) & kEven) | (((o >> 6) & kEven) << 8);
    std::memcpy(rgba + 2 * x, &average, sizeof(average));
  }
}

/// The message log of a shader or a program, through its two differently named pairs of getters.
template <typename GetNumber, typename GetText>
std::string Log(GLuint object, GetNumber get_number, GetText get_text) {
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
    const std::string log = Log(shader, gl.GetShaderiv, gl.GetShaderInfoLog);
    gl.DeleteShader(shader);
    throw std::runtime_error(std::string("shader ") + name + " does not compile: " + log);
  }
  return shader;
}

}  // namespace

GlProgram::GlProgram(const GlFunctions& gl, const char* name, std::string_view vertex,
                     std::string_view fragment)
    : gl_(gl) {
  const GLuint vertex_shader = Compile(gl, name, GL_VERTEX_SHADER, vertex);
  GLuint fragment_shader = 0;
  try {
    fragment_shader = Compile(gl, name, GL_FRAGMENT_SHADER, fragment);
  } catch (...) {
    gl.DeleteShader(vertex_shader);
    throw;
  }
  id_ = gl.CreateProgram();
  gl.AttachShader(id_, vertex_shader);
  gl.AttachShader(id_, fragment_shader);
  gl.LinkProgram(id_);
  gl.DeleteShader(vertex_shader);
  gl.DeleteShader(fragment_shader);
  GLint linked = 0;
  gl.GetProgramiv(id_, GL_LINK_STATUS, &linked);
  if (!linked) {
    const std::string log = Log(id_, gl.GetProgramiv, gl.GetProgramInfoLog);
    gl.DeleteProgram(id_);
    throw std::runtime_error(std::string("shader ") + name + " does not link: " + log);
  }
}

GlTarget::GlTarget(const GlFunctions& gl, int width, int height)
    : gl_(gl), width_(width), height_(height) {
  gl.GenFramebuffers(1, &frame_);
  gl.GenRenderbuffers(2, buffers_);
  gl.BindFramebuffer(GL_FRAMEBUFFER, frame_);
  // Depth as a number with a point: the rasterizer computes it so and need not convert.
  const GLenum formats[] = {GL_RGBA8, GL_DEPTH_COMPONENT32F};
  const GLenum points[] = {GL_COLOR_ATTACHMENT0, GL_DEPTH_ATTACHMENT};
  for (int i = 0; i < 2; ++i) {
    gl.BindRenderbuffer(GL_RENDERBUFFER, buffers_[i]);
    gl.RenderbufferStorage(GL_RENDERBUFFER, formats[i], width * kSide, height * kSide);
    gl.FramebufferRenderbuffer(GL_FRAMEBUFFER, points[i], GL_RENDERBUFFER, buffers_[i]);
  }
  if (gl.CheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
    gl.DeleteFramebuffers(1, &frame_);
    gl.DeleteRenderbuffers(2, buffers_);
    throw std::runtime_error("OpenGL cannot make a picture of " + std::to_string(width) + " x " +
                             std::to_string(height) + " with 4 samples");
  }
}

GlTarget::~GlTarget() {
  gl_.DeleteFramebuffers(1, &frame_);
  gl_.DeleteRenderbuffers(2, buffers_);
}

void GlTarget::Bind() const {
  gl_.BindFramebuffer(GL_FRAMEBUFFER, frame_);
  gl_.Viewport(0, 0, width_ * kSide, height_ * kSide);
}

void GlTarget::Read(std::uint8_t* rgba, bool soft) {
  // Few rows at a time, so that what is read stays in the cache until it is averaged.
  constexpr int kRowsAtOnce = 16;
  const auto row = static_cast<std::size_t>(width_) * kSide;
  const int last = height_ * kSide - 1;
  samples_.resize(row * (kRowsAtOnce * kSide + 2));
  sums_.resize(soft ? 2 * row : 0);
  gl_.BindFramebuffer(GL_READ_FRAMEBUFFER, frame_);
  gl_.PixelStorei(GL_PACK_ALIGNMENT, 1);
  for (int y = 0; y < height_; y += kRowsAtOnce) {
    const int rows = std::min(kRowsAtOnce, height_ - y);
    // GL's first row is the lowest.
    const int first = (height_ - y - rows) * kSide;
    const int from = soft ? std::max(first - 1, 0) : first;
    const int to = soft ? std::min(first + rows * kSide, last) : first + rows * kSide - 1;
    gl_.ReadPixels(0, from, width_ * kSide, to - from + 1, GL_RGBA, GL_UNSIGNED_BYTE,
                   samples_.data());
    const auto at = [&](int k) {
      return &samples_[row * static_cast<std::size_t>(std::clamp(k, from, to) - from)];
    };
    for (int k = rows - 1; k >= 0; --k) {
      const int low = first + kSide * k;
      if (soft) {
        SoftRow({at(low - 1), at(low), at(low + 1), at(low + 2)}, row, sums_.data(), rgba);
      } else {
        AverageRow(at(low), row, rgba);
      }
      rgba += row * 2;
    }
  }
}

void GlTarget::Show(int x, int y) const {
  gl_.BindFramebuffer(GL_READ_FRAMEBUFFER, frame_);
  // Halving with a linear filter takes the average of exactly four.
  gl_.BlitFramebuffer(0, 0, width_ * kSide, height_ * kSide, x, y, x + width_, y + height_,
                      GL_COLOR_BUFFER_BIT, GL_LINEAR);
}

}  // namespace fsm
