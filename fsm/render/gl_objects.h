#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <initializer_list>
#include <optional>
#include <ranges>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
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
  void Set(const char* name, bool value) const { Set(name, GLint{value}); }
  void Set(const char* name, TextureUnit unit) const { Set(name, static_cast<GLint>(unit)); }
  template <typename T>
  void Set(const char* name, const T& value) const {
    if constexpr (std::ranges::contiguous_range<T>) {
      Upload(name, std::data(value), std::size(value));
    } else {
      Upload(name, &value, 1);
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
  template <typename T>
  void Upload(const char* name, const T* values, std::size_t size) const {
    const auto location = Changed(name, std::as_bytes(std::span(values, size)));
    if (!location) return;
    const auto count = static_cast<GLsizei>(size);
    if constexpr (std::is_same_v<T, GLint>) {
      gl_.Uniform1iv(*location, count, values);
    } else if constexpr (std::is_same_v<T, float>) {
      gl_.Uniform1fv(*location, count, values);
    } else if constexpr (std::is_same_v<T, glm::vec2>) {
      gl_.Uniform2fv(*location, count, &values->x);
    } else if constexpr (std::is_same_v<T, glm::vec3>) {
      gl_.Uniform3fv(*location, count, &values->x);
    } else if constexpr (std::is_same_v<T, glm::vec4>) {
      gl_.Uniform4fv(*location, count, &values->x);
    } else if constexpr (std::is_same_v<T, glm::mat3>) {
      gl_.UniformMatrix3fv(*location, count, GL_FALSE, &values[0][0][0]);
    } else {
      static_assert(std::is_same_v<T, glm::mat4>);
      gl_.UniformMatrix4fv(*location, count, GL_FALSE, &values[0][0][0]);
    }
  }
  /// Links the attached shaders and deletes them.
  void Link(const char* name, std::initializer_list<GLuint> shaders);

  const GlFunctions& gl_;
  GLuint id_;
  mutable std::unordered_map<std::string_view, Uniform> uniforms_;  // those set so far
};

/// The framebuffer of a frame: colour and depth at twice the picture's size in each direction,
/// averaged 2 x 2 on read-out. In software that is faster and better than multisampling: llvmpipe
/// shades hidden pixels and blends each sample of a multisampled framebuffer separately, for which
/// the many small triangles of a face all pay. Destroy while its context is current.
class GlFramebuffer {
 public:
  /// Throws std::runtime_error if the driver cannot make it. Sizes are the finished picture's.
  GlFramebuffer(const GlFunctions& gl, int width, int height);
  ~GlFramebuffer() { Delete(); }
  GlFramebuffer(const GlFramebuffer&) = delete;
  GlFramebuffer& operator=(const GlFramebuffer&) = delete;

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
