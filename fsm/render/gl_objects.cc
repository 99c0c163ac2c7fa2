#include "fsm/render/gl_objects.h"

#include <stdexcept>

namespace fsm {
namespace {

constexpr GLsizei kSamples = 4;

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
  gl.GenFramebuffers(2, frames_);
  gl.GenRenderbuffers(3, buffers_);
  const GLenum formats[] = {GL_RGBA8, GL_DEPTH_COMPONENT24, GL_RGBA8};
  const GLenum points[] = {GL_COLOR_ATTACHMENT0, GL_DEPTH_ATTACHMENT, GL_COLOR_ATTACHMENT0};
  for (int i = 0; i < 3; ++i) {
    gl.BindRenderbuffer(GL_RENDERBUFFER, buffers_[i]);
    gl.RenderbufferStorageMultisample(GL_RENDERBUFFER, i < 2 ? kSamples : 0, formats[i], width,
                                      height);
    gl.BindFramebuffer(GL_FRAMEBUFFER, frames_[i < 2 ? 0 : 1]);
    gl.FramebufferRenderbuffer(GL_FRAMEBUFFER, points[i], GL_RENDERBUFFER, buffers_[i]);
  }
  for (const GLuint frame : frames_) {
    gl.BindFramebuffer(GL_FRAMEBUFFER, frame);
    if (gl.CheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
      gl.DeleteFramebuffers(2, frames_);
      gl.DeleteRenderbuffers(3, buffers_);
      throw std::runtime_error("OpenGL cannot make a picture of " + std::to_string(width) + " x " +
                               std::to_string(height) + " with 4 samples");
    }
  }
}

GlTarget::~GlTarget() {
  gl_.DeleteFramebuffers(2, frames_);
  gl_.DeleteRenderbuffers(3, buffers_);
}

void GlTarget::Bind() const {
  gl_.BindFramebuffer(GL_FRAMEBUFFER, frames_[0]);
  gl_.Viewport(0, 0, width_, height_);
}

void GlTarget::Resolve() const {
  gl_.BindFramebuffer(GL_READ_FRAMEBUFFER, frames_[0]);
  gl_.BindFramebuffer(GL_DRAW_FRAMEBUFFER, frames_[1]);
  gl_.BlitFramebuffer(0, 0, width_, height_, 0, 0, width_, height_, GL_COLOR_BUFFER_BIT,
                      GL_NEAREST);
}

}  // namespace fsm
