#pragma once

#include <cstdint>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <initializer_list>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "fsm/render/gl_functions.h"
#include "fsm/render/samples.h"

namespace fsm {

/// A linked shader program. Destroy while its context is current.
class GlProgram {
 public:
  /// Throws std::runtime_error with the compiler's words if a source is wrong; `name` is for them.
  GlProgram(const GlFunctions& gl, const char* name, std::string_view vertex,
            std::string_view fragment);
  /// Makes a program of a compute shader. REQUIRES: GlFunctions::has_compute.
  GlProgram(const GlFunctions& gl, const char* name, std::string_view compute);
  ~GlProgram() { gl_.DeleteProgram(id_); }
  GlProgram(GlProgram&& other) noexcept : gl_(other.gl_), id_(std::exchange(other.id_, 0)) {}
  GlProgram(const GlProgram&) = delete;
  GlProgram& operator=(const GlProgram&) = delete;

  void Use() const { gl_.UseProgram(id_); }
  /// Sets a uniform, or an array of them; one that the program does not have is ignored.
  /// REQUIRES of all: the program is in use.
  void Set(const char* name, float value) const { gl_.Uniform1f(At(name), value); }
  void Set(const char* name, GLint value) const { gl_.Uniform1i(At(name), value); }
  void Set(const char* name, GLuint value) const { gl_.Uniform1ui(At(name), value); }
  void Set(const char* name, const glm::vec3& value) const { Set(name, std::span(&value, 1)); }
  void Set(const char* name, const glm::vec4& value) const { Set(name, std::span(&value, 1)); }
  void Set(const char* name, const glm::mat3& value) const {
    gl_.UniformMatrix3fv(At(name), 1, GL_FALSE, &value[0][0]);
  }
  void Set(const char* name, const glm::mat4& value) const { Set(name, std::span(&value, 1)); }
  void Set(const char* name, std::span<const float> values) const {
    gl_.Uniform1fv(At(name), static_cast<GLsizei>(values.size()), values.data());
  }
  void Set(const char* name, std::span<const glm::vec3> values) const {
    gl_.Uniform3fv(At(name), static_cast<GLsizei>(values.size()), &values[0][0]);
  }
  void Set(const char* name, std::span<const glm::vec4> values) const {
    gl_.Uniform4fv(At(name), static_cast<GLsizei>(values.size()), &values[0][0]);
  }
  void Set(const char* name, std::span<const glm::mat4> values) const {
    gl_.UniformMatrix4fv(At(name), static_cast<GLsizei>(values.size()), GL_FALSE, &values[0][0][0]);
  }

 private:
  /// -1, which GL ignores, for a uniform the program does not use.
  GLint At(const char* name) const { return gl_.GetUniformLocation(id_, name); }
  /// Links what has been attached and lets the shaders go.
  void Link(const char* name, std::initializer_list<GLuint> shaders);

  const GlFunctions& gl_;
  GLuint id_;
};

/// Where a frame is drawn: colour and depth of twice the picture's size in each direction, averaged
/// 2 x 2 on the way out. Four samples like multisampling, but in software it is faster and better:
/// llvmpipe shades hidden pixels and blends every sample of a multisampled target one by one, and
/// of the small triangles of a face every one pays for that. Destroy while its context is current.
class GlTarget {
 public:
  /// Throws std::runtime_error if the driver cannot make it. Sizes: the finished picture's.
  GlTarget(const GlFunctions& gl, int width, int height);
  ~GlTarget();
  GlTarget(const GlTarget&) = delete;
  GlTarget& operator=(const GlTarget&) = delete;

  int width() const { return width_; }
  int height() const { return height_; }
  /// Makes it the one drawn into, all of it.
  void Bind() const;
  std::size_t samples_in_row() const { return static_cast<std::size_t>(width_) * kSamplesAlong; }
  /// The averaged picture; `soft` as of AverageSamples.
  void Read(Image& out, bool soft);
  /// RGBA8 samples of the rows from .. to, the lowest first: into memory, or where a
  /// GL_PIXEL_PACK_BUFFER is bound into that.
  void ReadRows(int from, int to, void* samples) const;
  /// Averages into the framebuffer bound as GL_DRAW_FRAMEBUFFER, its lower left corner at (x, y).
  void Show(int x, int y) const;

 private:
  const GlFunctions& gl_;
  int width_;
  int height_;
  GLuint frame_ = 0;
  GLuint buffers_[2] = {};              // colour, depth
  std::vector<std::uint32_t> samples_;  // some rows of RGBA8, as they are read
};

}  // namespace fsm
