#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "fsm/base/enum_names.h"
#include "fsm/render/gl_functions.h"
#include "fsm/render/samples.h"
#include "fsm/render/texture_unit.h"

namespace fsm {

/// Returns "#define NAME NUMBER" for every value of an enumeration, as the first lines of a shader.
template <typename E>
std::string ShaderNumbers() {
  std::string text;
  [&]<int... kNumbers>(std::integer_sequence<int, kNumbers...>) {
    ((text += "#define " + std::string(NameOf<static_cast<E>(kNumbers)>()) + ' ' +
              std::to_string(kNumbers) + '\n'),
     ...);
  }
  (std::make_integer_sequence<int, kValuesOf<E>>());
  return text;
}

/// A linked shader program. Destroy while its context is current.
class GlProgram {
 public:
  /// Throws std::runtime_error with the compiler's log, prefixed by `name`, if a source is wrong.
  GlProgram(const GlFunctions& gl, const char* name, std::string_view vertex,
            std::string_view fragment);
  /// Makes a program of a compute shader. REQUIRES: GlFunctions::has_compute.
  GlProgram(const GlFunctions& gl, const char* name, std::string_view compute);
  ~GlProgram() { gl_.DeleteProgram(id_); }
  GlProgram(GlProgram&& other) noexcept
      : gl_(other.gl_), id_(std::exchange(other.id_, 0)), uniforms_(std::move(other.uniforms_)) {}
  GlProgram(const GlProgram&) = delete;
  GlProgram& operator=(const GlProgram&) = delete;

  void Use() const { gl_.UseProgram(id_); }
  /// Sets a uniform or an array of uniforms; a name that the program does not have is ignored.
  /// REQUIRES for all: the program is in use, `name` is a string literal.
  void Set(const char* name, float value) const { Set(name, std::span(&value, 1)); }
  void Set(const char* name, GLint value) const {
    if (const auto location = Changed(name, std::as_bytes(std::span(&value, 1)))) {
      gl_.Uniform1i(*location, value);
    }
  }
  void Set(const char* name, bool value) const { Set(name, GLint{value}); }
  void Set(const char* name, TextureUnit unit) const { Set(name, static_cast<GLint>(unit)); }
  void Set(const char* name, const glm::vec3& value) const { Set(name, std::span(&value, 1)); }
  void Set(const char* name, const glm::vec4& value) const { Set(name, std::span(&value, 1)); }
  void Set(const char* name, const glm::mat3& value) const {
    if (const auto location = Changed(name, std::as_bytes(std::span(&value, 1)))) {
      gl_.UniformMatrix3fv(*location, 1, GL_FALSE, &value[0][0]);
    }
  }
  void Set(const char* name, const glm::mat4& value) const { Set(name, std::span(&value, 1)); }
  void Set(const char* name, std::span<const float> values) const {
    if (const auto location = Changed(name, std::as_bytes(values))) {
      gl_.Uniform1fv(*location, static_cast<GLsizei>(values.size()), values.data());
    }
  }
  void Set(const char* name, std::span<const glm::vec3> values) const {
    if (const auto location = Changed(name, std::as_bytes(values))) {
      gl_.Uniform3fv(*location, static_cast<GLsizei>(values.size()), &values[0][0]);
    }
  }
  void Set(const char* name, std::span<const glm::vec4> values) const {
    if (const auto location = Changed(name, std::as_bytes(values))) {
      gl_.Uniform4fv(*location, static_cast<GLsizei>(values.size()), &values[0][0]);
    }
  }
  void Set(const char* name, std::span<const glm::mat4> values) const {
    if (const auto location = Changed(name, std::as_bytes(values))) {
      gl_.UniformMatrix4fv(*location, static_cast<GLsizei>(values.size()), GL_FALSE,
                           &values[0][0][0]);
    }
  }

 private:
  struct Uniform {
    GLint location;  ///< -1: the program has no such uniform
    std::vector<std::byte> value;
  };
  /// Returns the location of a uniform if it exists and has another value: this check is far
  /// cheaper than a driver's look-up of a name or store of a value.
  std::optional<GLint> Changed(const char* name, std::span<const std::byte> value) const;
  /// Links the attached shaders and deletes them.
  void Link(const char* name, std::initializer_list<GLuint> shaders);

  const GlFunctions& gl_;
  GLuint id_;
  mutable std::unordered_map<std::string_view, Uniform> uniforms_;  // those set so far
};

/// The framebuffer of a frame: colour and depth at twice the picture's size in each direction,
/// averaged 2 x 2 on read-out. In software that is faster and better than multisampling: llvmpipe
/// shades hidden pixels and blends each sample of a multisampled target separately, for which the
/// many small triangles of a face all pay. Destroy while its context is current.
class GlTarget {
 public:
  /// Throws std::runtime_error if the driver cannot make it. Sizes are the finished picture's.
  GlTarget(const GlFunctions& gl, int width, int height);
  ~GlTarget() { Delete(); }
  GlTarget(const GlTarget&) = delete;
  GlTarget& operator=(const GlTarget&) = delete;

  int width() const { return width_; }
  int height() const { return height_; }
  /// Binds the whole framebuffer for drawing.
  void Bind() const;
  std::size_t samples_in_row() const { return static_cast<std::size_t>(width_) * kSamplesAlong; }
  /// Reads the averaged picture.
  void Read(Image& out, Filter filter);
  GLuint samples() const { return colour_; }  ///< an RGBA8 texture, lowest row first
  /// Averages into the bound GL_DRAW_FRAMEBUFFER, with the lower left corner at (x, y).
  void Show(int x, int y) const;

 private:
  void Delete();
  /// Reads the RGBA8 samples of the rows from .. to, lowest first.
  void ReadRows(int from, int to, void* samples) const;

  const GlFunctions& gl_;
  int width_;
  int height_;
  GLuint frame_ = 0, colour_ = 0, depth_ = 0;
  std::vector<std::uint32_t> samples_;  // some rows of RGBA8 samples being read
};

}  // namespace fsm
