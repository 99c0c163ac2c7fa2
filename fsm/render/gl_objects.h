#pragma once

#include <cstdint>
#include <initializer_list>
#include <string>
#include <string_view>
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
  GlProgram(const GlProgram&) = delete;
  GlProgram& operator=(const GlProgram&) = delete;

  GLuint id() const { return id_; }
  /// -1, which GL ignores, for a uniform the program does not use.
  GLint Uniform(const char* name) const { return gl_.GetUniformLocation(id_, name); }

 private:
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
